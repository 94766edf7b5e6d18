#include "io/ros/dds_publisher.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

[[noreturn]] void fail_without_dds() {
  fail(
      "this build cannot publish by DDS; it needs the packages cyclonedds-dev and cyclonedds-tools (0.10), and "
      "CMake's ",
      "-DROADSTEREO_DDS=ON");
}

}  // namespace

struct DdsPublisher::State {};

DdsPublisher::DdsPublisher(std::uint32_t /*domain*/, std::span<const RosTopic> /*topics*/) {
  fail_without_dds();
}

DdsPublisher::~DdsPublisher() = default;

bool DdsPublisher::has_subscribers() const {
  fail_without_dds();
}

void DdsPublisher::publish(std::span<const TopicMessage> /*messages*/) {
  fail_without_dds();
}

}  // namespace roadstereo::io
