#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "io/ros/dds_publisher.hpp"
#include "live/path_finder.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Publishes processed pairs as ROS 2 messages by DDS, with the topics of flight.mcap. Only while there are
/// subscribers; poses only of those frames that a bounded share of the time allows.
class LiveMessages {
 public:
  /// `calibration` absent: image and disparities only. Throws Error if the domain cannot be joined.
  LiveMessages(std::uint32_t domain, const std::optional<StereoCalibration>& calibration);

  /// Publishes one pair; `left` is the rectified image, `clock_s` the time of its arrival since 1970.
  void publish(const FrameView& left, double white_level, double clock_s, const FrameResult& result,
               const DamageMap& damage);

 private:
  std::optional<io::RosPose> next_pose(const FrameResult& result);

  std::optional<StereoCalibration> calibration_;
  io::DdsPublisher publisher_;
  std::optional<PathFinder> path_;  // with a calibration
  std::uint32_t sequence_ = 0;
};

}  // namespace roadstereo::cli
