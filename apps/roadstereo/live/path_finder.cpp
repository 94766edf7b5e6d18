#include "live/path_finder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// Index of a frame: milliseconds, so that the odometry predicts motion by time.
int index_of(Clock::time_point first, Clock::time_point arrival) {
  constexpr std::int64_t wrap = 1LL << 30;  // 12 days
  return static_cast<int>(static_cast<std::int64_t>(1000 * seconds_between(first, arrival)) % wrap);
}

/// Direction of the view on the road, clockwise from y; of a camera that looks straight down, that of the image's top.
double heading_of(const std::array<double, 12>& pose) {
  constexpr double least_along_road = 0.1;
  const double along = std::hypot(pose[2], pose[6]);
  return along > least_along_road ? std::atan2(pose[2], pose[6]) : std::atan2(-pose[1], -pose[5]);
}

}  // namespace

PathFinder::PathFinder(const StereoCalibration& calibration) : calibration_(calibration) {
  begin_piece();
}

void PathFinder::begin_piece() {
  constexpr int kept = 100;
  OdometryOptions options;
  options.kept_frames = kept;
  options.threads = 1;  // the other cores are busy matching
  odometry_.emplace(calibration_, options);
  on_road_.emplace(calibration_);
  piece_ = 0;
}

/// Frames of another size, and an index that does not grow, begin anew.
std::optional<io::RosPose> PathFinder::locate(const FollowedFrame& frame) {
  const OdometryFrame maps{frame.grey, frame.disparity, frame.sigma, frame.road.has_value(),
                           frame.road.value_or(DisparityPlane{})};
  const int index = index_of(first_arrival_, frame.arrival);
  const FramePose* pose = nullptr;
  try {
    pose = &odometry_->add(index, maps);
  } catch (const Error&) {
    begin_piece();
    ++pieces_;
    path_.clear();
    pose = &odometry_->add(index, maps);
  }
  if (pose->piece != piece_) {
    piece_ = pose->piece;
    ++pieces_;
    path_.clear();
  }
  return on_road_->add(*pose, frame.road);
}

SharedPath PathFinder::path(const io::RosPose& pose) const {
  constexpr double ms = 1000;
  LivePath path;
  path.points_m = path_.points_m();
  path.heading_rad = heading_of(pose.camera_to_odom);
  path.length_m = path_.length_m();
  path.pieces = pieces_;
  path.odometry_ms = ms * spent_s_ / frames_;
  const double elapsed_s = seconds_between(start_, std::max(Clock::now(), due_));
  path.share = elapsed_s > 0 ? spent_s_ / elapsed_s : 0;
  return std::make_shared<const LivePath>(std::move(path));
}

std::optional<io::RosPose> PathFinder::follow(const FollowedFrame& frame) {
  if (!is_due()) return std::nullopt;
  const Clock::time_point begin = Clock::now();
  if (frames_ == 0) {
    first_arrival_ = frame.arrival;
    start_ = begin;
  }
  const std::optional<io::RosPose> pose = locate(frame);
  const double took_s = seconds_between(begin, Clock::now());
  spent_s_ += took_s;
  ++frames_;
  due_ = begin + clock_span(took_s / max_share);
  return pose;
}

SharedPath PathFinder::add(const FollowedFrame& frame) {
  const std::optional<io::RosPose> pose = follow(frame);
  if (!pose) return nullptr;
  path_.add(pose->camera_to_odom[3], pose->camera_to_odom[7]);
  return path(*pose);
}

}  // namespace roadstereo::cli
