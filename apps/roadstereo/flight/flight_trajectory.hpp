#pragma once

#include <string>
#include <vector>

#include "flight/flight_job.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Names of the files of a trajectory.
const std::vector<std::string>& trajectory_file_names();

/// Trajectory of a flight, frame by frame.
class FlightTrajectory {
 public:
  explicit FlightTrajectory(const StereoCalibration& calibration) : odometry_(calibration) {}

  /// Adds the next matched frame.
  void add(const io::FlightFrame& frame, const FrameResult& result);

  /// Returns trajectory_kitti.txt and trajectory.tum (the longest piece), trajectory.csv and links.csv (all of them).
  std::vector<StagedFile> files() const;

  /// Returns one line: path, pieces, weak links, offset of the disparities.
  std::string summary() const;

 private:
  Odometry odometry_;
  std::vector<double> times_s_;
};

}  // namespace roadstereo::cli
