#include "flight/flight_motion.hpp"

#include "roadstereo/road_map.hpp"

namespace roadstereo::cli {

FlightMotion::FlightMotion(const FlightSettings& settings, Flight& flight, const std::optional<io::FlightFrame>& last)
    : settings_(settings), flight_(flight), last_(last), first_piece_(flight.results.motion_pieces()) {}

const FramePose& FlightMotion::link(FlightJob& job, const StereoCalibration& calibration) {
  const int threads = flight_.plan.options.threads;
  if (!settings_.trajectory) {
    if (!odometry_) odometry_.emplace(calibration, OdometryOptions{.kept_frames = 1, .threads = threads});
    return odometry_->add(static_cast<int>(job.frame.index), job.result, job.frame.time_s);
  }
  if (!flight_.trajectory) flight_.trajectory.emplace(calibration, flight_.folder.path() / ".keyframes", threads);
  job.pose = flight_.trajectory->add(job.frame, job.result);
  return flight_.trajectory->last_pose();
}

void FlightMotion::add_pose(FlightJob& job) {
  const std::optional<StereoCalibration>& calibration = flight_.source.calibration();
  if (!calibration) return;
  const FramePose& pose = link(job, *calibration);
  if (!job.result.roll_found) return;
  const RigidTransform road_to_camera = inverse(camera_to_road(job.result.geometry.plane, *calibration));
  const RigidTransform road_to_world = compose(pose.camera_to_world, road_to_camera);
  if (last_ && last_->pose && job.frame.index == last_->index) {
    joined_piece_ = pose.piece;
    to_earlier_ = compose(last_->pose->road_to_world, inverse(road_to_world));
  }
  if (pose.piece == joined_piece_) {
    job.frame.pose = {last_->pose->piece, compose(to_earlier_, road_to_world)};
  } else {
    job.frame.pose = {first_piece_ + pose.piece, road_to_world};
  }
}

}  // namespace roadstereo::cli
