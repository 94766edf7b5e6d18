#pragma once

#include <optional>

#include "io/ros/road_odometry.hpp"
#include "live/camera_path.hpp"
#include "live/clock.hpp"
#include "live/live_path.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Maps of a matched frame.
struct FollowedFrame {
  GreyImage grey;
  Image<float> disparity, sigma;
  std::optional<DisparityPlane> road;
  Clock::time_point arrival{};
};

/// Follows the camera from frame to frame in bounded memory and a bounded share of the time: after a frame it skips
/// those that arrive before its time is no more than that share.
class PathFinder {
 public:
  static constexpr double max_share = 0.3;

  explicit PathFinder(const StereoCalibration& calibration);

  /// Whether the next frame would not be skipped.
  bool is_due() const { return frames_ == 0 || Clock::now() >= due_; }

  /// Adds the next frame. Returns its pose, or nothing if the frame was skipped or has no place yet.
  std::optional<io::RosPose> follow(const FollowedFrame& frame);

  /// The same, and the path so far.
  SharedPath add(const FollowedFrame& frame);

 private:
  std::optional<io::RosPose> locate(const FollowedFrame& frame);
  void begin_piece();
  SharedPath path(const io::RosPose& pose) const;

  StereoCalibration calibration_;
  std::optional<Odometry> odometry_;
  std::optional<io::RoadOdometry> on_road_;
  int piece_ = 0;   ///< of the odometry
  int pieces_ = 1;  ///< so far
  CameraPath path_;
  Clock::time_point first_arrival_{}, start_{}, due_{};
  int frames_ = 0;
  double spent_s_ = 0;
};

}  // namespace roadstereo::cli
