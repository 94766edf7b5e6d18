#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace roadstereo::cli {

/// Camera to world, 3×4, row-major, metres.
using Pose = std::array<double, 12>;

/// Returns the pose as a rigid transform.
Eigen::Isometry3d isometry(const Pose& pose);

/// Errors of a trajectory against the truth.
struct TrajectoryScore {
  double path_m = 0;               ///< length of the true path
  double translation_percent = 0;  ///< mean error of the motion over pieces of the path, of their length
  double rotation_deg_per_m = 0;   ///< likewise
  double absolute_percent = 0;     ///< RMS of the positions after a rigid alignment, of the path: ATE
  std::size_t pieces = 0;          ///< number of pieces of the path
  /// Constant angles about x and y between the axes of the true poses and those in which the estimate moves, radians:
  /// what a truth of another sensor adds where its place on the vehicle is not known as well.
  std::array<double, 2> axes_turn_rad{};
  double turned_percent = 0;  ///< translation_percent without that turn
};

/// Returns the errors as KITTI odometry defines them, from every frame over 10, 20, … 50 m of path (paths shorter than
/// 20 m: over tenths of it, up to a half), and the absolute trajectory error after an alignment by Umeyama's method
/// without scale. Both have one pose per frame. Throws Error for fewer than three frames, or a path of no length.
TrajectoryScore score_trajectory(const std::vector<Pose>& truth, const std::vector<Pose>& estimate);

}  // namespace roadstereo::cli
