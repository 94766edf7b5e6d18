#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flight/camera_place.hpp"
#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"
#include "io/ros/road_odometry.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/loop_search.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Names of the files of a trajectory.
const std::vector<std::string>& trajectory_file_names();

/// Trajectory of a flight: odometry frame by frame, and at the end the pose graph, if this build has it.
class FlightTrajectory {
 public:
  /// `keyframes` becomes a folder of this trajectory's own, and is removed with it.
  FlightTrajectory(const StereoCalibration& calibration, const std::filesystem::path& keyframes, int threads);

  /// Adds the next matched frame. Returns its pose for flight.mcap, if it has one.
  std::optional<io::RosPose> add(const io::FlightFrame& frame, const FrameResult& result);

  /// Pose of the frame that was added last, by odometry alone.
  const FramePose& last_pose() const { return odometry_.trajectory().frames.back(); }

  /// Closes loops, and places the trajectory on the Earth if there is a track that fits it.
  void optimise(const TrackSettings& track);

  /// Returns trajectory_kitti.txt and trajectory.tum (the longest piece), trajectory.csv, links.csv and loops.csv
  /// (all).
  std::vector<StagedFile> files() const;

  /// The coordinate system of the poses, as GDAL reads it; empty: the axes of the first camera.
  const std::string& crs() const { return crs_; }

  /// Where the cameras were on the Earth, in order; empty unless a track fits the trajectory.
  const std::vector<CameraPlace>& places() const { return places_; }

  /// How track and trajectory fit; absent without a track, or if it is not used.
  const std::optional<TrackFit>& track_fit() const { return graph_.track; }
  /// Why the track is not used, a sentence; empty if it is, or without one.
  const std::string& track_unused() const { return graph_.track_unused; }

  /// Why the track cannot be that of this flight, a sentence; empty without one, or if it can.
  std::string track_contradiction() const { return graph_.track_contradicts ? graph_.track_unused : std::string(); }

  /// What the links show: a wrong offset of the disparities, shutters that roll, a delay between both exposures.
  std::vector<HealthFinding> findings() const;

  /// Returns one line: path, pieces, weak links, offset of the disparities, loops, track.
  std::string summary() const;

 private:
  const Trajectory& trajectory() const;

  Odometry odometry_;
  std::optional<LoopSearch> loops_;
  io::RoadOdometry road_odometry_;
  std::vector<double> times_s_;
  std::vector<std::optional<RoadAxes>> road_axes_;  ///< of each frame, in its camera's frame
  StereoCalibration calibration_;
  PoseGraphResult graph_;  ///< empty before `optimise`
  std::string crs_;
  std::vector<CameraPlace> places_;
};

}  // namespace roadstereo::cli
