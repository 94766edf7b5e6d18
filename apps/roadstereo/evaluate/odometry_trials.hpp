#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "evaluate/trajectory_score.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo::cli {

struct OdometryTrialOptions {
  std::string folder;                    ///< recording with poses.txt; empty: a rendered flight
  std::vector<std::string> calibration;  ///< empty: calibration.yaml of the folder
  std::string scene = "uav";
  std::string size = "640x360";
  std::string flight = "default";
  int frames = 300;       ///< of a rendered flight
  int supersampling = 1;  ///< rays per pixel and axis of the renderer
  double noise_grey = 2;  ///< of a rendered flight, 8-bit grey levels
  std::string preset = "default";
  /// Compared with: "flow" (OpenCV's optical flow and PnP), "rgbd" (its RgbdOdometry), "open3d" and "colmap", programs
  /// of their own.
  std::vector<std::string> peers{"flow", "rgbd"};
  MethodSettings methods;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Trajectory of one method and its errors.
struct OdometryTrial {
  std::string method;
  TrajectoryScore score;
  std::vector<double> link_errors_px;  ///< RMS displacement of pixels of the later frame by the error of a link
  std::vector<double> link_errors_sd;  ///< RMS of the six whitened errors of a link: 1 if its covariance is right
  std::vector<double> pose_errors_sd;  ///< the same of the poses against the first one
  std::size_t lost = 0;                ///< frames without a link, but the first
  double median_ms = 0;                ///< of a frame, without matching; of programs the mean
};

struct OdometryTrials {
  std::vector<OdometryTrial> methods;  ///< this library, with its pose graph if the build has one, then the peers
  std::vector<std::string> missing;    ///< peers that were asked for and could not be run: why
  double matching_ms = 0;              ///< median time of Pipeline::process
  double offset_px = 0;                ///< median disparity offset at infinity of the links that undid one
  std::size_t with_offset = 0;         ///< number of those links
  std::size_t links = 0;
  std::optional<PoseGraphResult> graph;
  std::size_t compared = 0;  ///< pairs of frames in which a loop was searched
};

/// Processes a recording whose poses are known, or a rendered flight, frame by frame.
OdometryTrials run_odometry_trials(const OdometryTrialOptions& options);

}  // namespace roadstereo::cli
