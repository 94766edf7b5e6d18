#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/measurement.hpp"
#include "roadstereo/odometry.hpp"
#include "roadstereo/trajectory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

// Pose graph: nonlinear least squares over the poses of all frames, weighted by covariance, with robust losses. Needs a
// build with Ceres (CMake option ROADSTEREO_CERES); without it `optimise_poses` throws Error naming the package.

/// Whether this build has Ceres.
bool has_pose_graph();

/// Link between frames far apart in time that show the same place.
struct LoopLink {
  FrameLink link;
  std::array<double, 3> centre_m{};  ///< point of the road at the centre of the image, in the axes of camera `link.to`
  double pixel_m = 0;                ///< side of a pixel there
  bool used = false;                 ///< agrees with the graph
  double before_m = 0;               ///< misclosure at `centre_m` of the trajectory without loops
  double after_m = 0;                ///< ... with loops
};

/// Position of a GNSS antenna in axes of the Earth: x east, y north, z up. All fixes have one unknown error in common,
/// each in proportion to these standard errors. In addition each has its own noise, in proportion to them as well,
/// whose size is estimated from the fit to the trajectory.
struct PositionFix {
  double time_s = 0;
  std::array<double, 3> position_m{};  ///< z NaN: unknown
  double horizontal_sd_m = 2.5;        ///< standard error of x and of y, > 0
  double vertical_sd_m = 5;            ///< standard error of z, > 0

  /// Throws Error naming the first value out of range.
  void validate() const;
};

struct PoseGraphInput {
  Trajectory trajectory;        ///< of `Odometry`
  std::vector<double> times_s;  ///< of its frames; NaN unknown. Needed for fixes only
  /// Normal of the road in each frame, pointing up out of the road, in camera axes; absent without a road. Roads are
  /// assumed level within 3° on average, which matters where the fixes determine the tilt less well. Needed for fixes
  /// only.
  std::vector<std::optional<std::array<double, 3>>> road_up;
  std::vector<FrameLink> links;
  std::vector<LoopLink> loops;
  std::vector<PositionFix> fixes;  ///< in order of time; empty: none
};

struct PoseGraphOptions {
  double max_time_offset_s = 30;  ///< between the clocks of frames and fixes, 0 … 600
  double time_offset_sd_s = 10;  ///< standard deviation of the expected time offset, 0.001 … 600; 0 is taken if it fits
                                 ///< and the data do not tell another one twice as well, or no other than clocks have
                                 ///< that run together (0.05 s)
  double lever_arm_sd_m = 1;  ///< expected distance of the antenna from the camera, per axis, 0.001 … 100; an axis
                              ///< that the data do not tell twice as well is 0
  double fix_correlation_s = 10;  ///< within this time the noise of fixes is the same, 0 … 3600
  double max_fix_gap_s = 5;       ///< no position between fixes, or frames, farther apart in time, 0.001 … 3600

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// How fixes and trajectory fit.
struct TrackFit {
  Measurement time_offset_s;               ///< to be added to the times of the frames
  bool time_offset_found = true;           ///< false: the data do not tell it, so that it is what was expected
  std::array<Measurement, 3> lever_arm_m;  ///< antenna in camera axes
  double rms_m = 0;                        ///< of the distances that remain, horizontally
  std::size_t frames = 0;                  ///< with a position
};

struct PoseGraphResult {
  /// Without fixes: in the world of the input, with the first frame of each piece unchanged. With fixes: x east, y
  /// north, z up; everything that they anchor is piece 0, and the covariances are those of the position on the Earth.
  Trajectory trajectory;
  std::vector<LoopLink> loops;     ///< the loops of the input, with `used` and the misclosures filled in
  std::optional<TrackFit> track;   ///< absent without fixes, or if they cannot be used
  std::string track_unused;        ///< why the fixes cannot be used, as a sentence; empty if they are used
  bool track_contradicts = false;  ///< whether the fixes contradict the trajectory

  std::size_t loops_used() const;
  /// RMS misclosure of the loops used, metres and pixels of the ground, without and with loops; 0 without loops.
  struct Misclosure {
    double before_m = 0, after_m = 0, before_px = 0, after_px = 0;
  };
  Misclosure misclosure() const;
};

/// Optimises the poses. Loops that contradict the trajectory (χ² test with 16 times the covariance of both) or other
/// loops (Cauchy loss) have no weight. Fixes that do not fit the trajectory at any time offset, or only mirrored, are
/// refused. The result does not depend on the number of threads. Throws Error for options out of range, frames with two
/// poses, links of unknown frames, fixes that are out of range or not in order of time, fixes without `times_s` and
/// `road_up` for every frame, a graph that cannot be solved, or a build without Ceres.
PoseGraphResult optimise_poses(const PoseGraphInput& input, const PoseGraphOptions& options = {});

}  // namespace roadstereo
#pragma GCC visibility pop
