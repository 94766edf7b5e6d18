#pragma once

#include <optional>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"
#include "flight/run_flight.hpp"
#include "roadstereo/odometry.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::cli {

/// Poses of the frames of a flight, by which its damages are known again: by its trajectory, or by odometry alone.
class FlightMotion {
 public:
  /// Goes on from `last`, the last frame of an earlier run, if there is one.
  FlightMotion(const FlightSettings& settings, Flight& flight, const std::optional<io::FlightFrame>& last);

  /// Links a matched frame with those before it, which have its size, and gives it a pose if it shows a road.
  void add_pose(FlightJob& job);

 private:
  const FramePose& link(FlightJob& job, const StereoCalibration& calibration);

  const FlightSettings& settings_;
  Flight& flight_;
  const std::optional<io::FlightFrame>& last_;
  const int first_piece_;             ///< of the motion, after those of an earlier run
  int joined_piece_ = -1;             ///< of this run's odometry: the one that goes on from `last_`
  RigidTransform to_earlier_{};       ///< from its world to that of the earlier run
  std::optional<Odometry> odometry_;  ///< without a trajectory
};

}  // namespace roadstereo::cli
