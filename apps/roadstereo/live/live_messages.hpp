#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "io/ros/dds_publisher.hpp"
#include "io/ros/road_odometry.hpp"
#include "roadstereo/odometry.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Publishes processed pairs as ROS 2 messages by DDS, with the topics of flight.mcap.
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
  std::optional<Odometry> odometry_;  // with a calibration
  std::optional<io::RoadOdometry> road_odometry_;
  std::uint32_t sequence_ = 0;
};

}  // namespace roadstereo::cli
