#include "evaluation/peer_rgbd.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

struct RgbdOdometry::State {};

bool RgbdOdometry::available() {
  return false;
}

RgbdOdometry::RgbdOdometry(const StereoCalibration&) {
  fail("this build has no RgbdOdometry: the module rgbd of libopencv-contrib-dev was missing");
}
RgbdOdometry::~RgbdOdometry() = default;

std::optional<std::array<double, 12>> RgbdOdometry::add(const GreyImage&, const Image<float>&) {
  return std::nullopt;
}

}  // namespace roadstereo::io
