// Topics of a recording's or a camera's results, and the messages of one frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/ros/messages.hpp"
#include "io/ros/topic.hpp"
#include "roadstereo/disparity_plane.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Pose of the left camera in the frame `odom`.
struct RosPose {
  std::array<double, 12> camera_to_odom{};  ///< 3×4, row-major, metres
  std::array<double, 36> covariance{};      ///< position, then rotation, about the axes of `odom`
};

/// A matched frame.
struct RosFrame {
  std::uint32_t sequence = 0;  ///< number of the frame in the flight, from 0
  double time_s = 0;           ///< since 1970, or since the start; not negative, before 2038
  FrameView left;              ///< rectified
  double white_level = 0;      ///< sample value of white; 0: maximum of the sample type
  RosPoints maps;
  std::span<const Damage> damages;
  const StereoCalibration* calibration = nullptr;  ///< null: without points, damages and transforms
  std::optional<DisparityPlane> road;              ///< after matching
  std::optional<RosPose> pose;
};

/// Topics; the images and disparities alone without a calibration.
std::vector<RosTopic> flight_topics(bool calibrated, bool with_odometry);

/// Messages of a frame in the order of `flight_topics`. Throws Error for a time out of range.
std::vector<TopicMessage> flight_messages(const RosFrame& frame);

}  // namespace roadstereo::io
#pragma GCC visibility pop
