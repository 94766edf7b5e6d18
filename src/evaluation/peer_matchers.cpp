#include "evaluation/peer_matchers.hpp"

#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "evaluation/peer_maps.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

cv::Ptr<cv::StereoMatcher> make_matcher(const std::string& name, int disparities) {
  constexpr int bm_block = 11;
  const auto semi_global = [&](int mode) {
    constexpr int block = 5;
    return cv::StereoSGBM::create(0, disparities, block, 8 * block * block, 32 * block * block, 1, 63, 10, 100, 2,
                                  mode);
  };
  if (name == "SGBM") return semi_global(cv::StereoSGBM::MODE_SGBM);
  if (name == "3WAY") return semi_global(cv::StereoSGBM::MODE_SGBM_3WAY);
  if (name == "HH4") return semi_global(cv::StereoSGBM::MODE_HH4);
  if (name == "BM") return cv::StereoBM::create(disparities, bm_block);
  fail("there is no matcher called '", name, "' to compare with; there are: SGBM, 3WAY, HH4, BM");
}

}  // namespace

const std::vector<std::string>& peer_names() {
  static const std::vector<std::string> names{"SGBM", "3WAY", "HH4", "BM"};
  return names;
}

struct PeerMatcher::State {
  cv::Ptr<cv::StereoMatcher> matcher;
  cv::Mat reference, target, disparity;
};

int peer_disparities(int disparities) {
  constexpr int grid = 16;
  return (disparities + grid - 1) / grid * grid;
}

PeerMatcher::PeerMatcher(const std::string& name, int disparities) : state_(std::make_unique<State>()) {
  state_->matcher = make_matcher(name, peer_disparities(disparities));
}
PeerMatcher::~PeerMatcher() = default;
PeerMatcher::PeerMatcher(PeerMatcher&&) noexcept = default;
PeerMatcher& PeerMatcher::operator=(PeerMatcher&&) noexcept = default;

void PeerMatcher::set_pair(const GreyImage& reference, const GreyImage& target) {
  state_->reference = grey_bytes(reference);
  state_->target = grey_bytes(target);
}

void PeerMatcher::match() {
  state_->matcher->compute(state_->reference, state_->target, state_->disparity);
}

Image<float> PeerMatcher::disparity() const {
  constexpr float scale = 16;
  const cv::Mat& found = state_->disparity;
  Image<float> map(found.cols, found.rows);
  for (int v = 0; v < found.rows; ++v) {
    for (int u = 0; u < found.cols; ++u) {
      const std::int16_t value = found.at<std::int16_t>(v, u);
      map(u, v) = value < 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value) / scale;
    }
  }
  return map;
}

}  // namespace roadstereo::io
