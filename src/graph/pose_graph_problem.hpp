#pragma once

#include <ceres/ceres.h>

#include <memory>
#include <vector>

#include "graph/graph_pose.hpp"
#include "graph/residuals.hpp"
#include "graph/sparse_covariance.hpp"

namespace roadstereo {

/// What is estimated besides poses, with a track.
struct TrackUnknowns {
  Eigen::Vector3d lever_arm = Eigen::Vector3d::Zero();
  Eigen::Vector3d fix_error = Eigen::Vector3d::Zero();  ///< common to all fixes
  double time_offset_s = 0;
};

/// Covariance of a link. Variances below what rounding leaves would make it singular.
Eigen::Matrix<double, 6, 6> covariance_of(const FrameLink& link);

/// Least-squares problem of a pose graph (Ceres, Levenberg–Marquardt on normal equations, one thread, so that the
/// result does not depend on the number of threads).
class PoseGraphProblem {
 public:
  /// Poses and unknowns are changed by `solve`; both outlive the problem.
  PoseGraphProblem(std::vector<GraphPose>& poses, TrackUnknowns& track);

  /// Links of the odometry have Huber's loss, loops Cauchy's.
  void add_link(std::size_t from, std::size_t to, const FrameLink& link, bool is_loop);
  /// `count`: positions that share one error.
  void add_fix(std::size_t frame, const FixResidual& residual, double count);
  void add_level(std::size_t frame, const Eigen::Vector3d& up, double weight);
  /// Expected size of what is estimated besides poses, and the largest offset of the clocks.
  void add_track_prior(const Eigen::Vector3d& fix_error_sd, double lever_arm_sd, double time_offset_sd,
                       double max_time_offset_s);
  void hold(std::size_t frame);
  /// Leaves the time offset as it is in `solve`; its uncertainty remains.
  void hold_time_offset();
  /// The same for the lever arm along these axes of the camera.
  void hold_lever_arm(const std::vector<int>& axes);

  void solve();

  /// Linearises the problem where it stands; a time offset and axes that were held are free then.
  void linearise();
  /// Covariance of a pose: translation, then rotation vector, in the axes of its camera. After `linearise`.
  Eigen::Matrix<double, 6, 6> covariance(std::size_t frame);
  /// ... of the motion from the camera of one frame to that of another, in the axes of the latter.
  Eigen::Matrix<double, 6, 6> relative_covariance(std::size_t from, std::size_t to) const;
  /// Standard errors of lever arm and time offset.
  Eigen::Vector4d track_deviations();

 private:
  Eigen::Matrix<double, 6, 6> to_camera(std::size_t frame) const;

  std::vector<GraphPose>& poses_;
  TrackUnknowns& track_;
  ceres::Problem problem_;
  std::vector<int> columns_;  ///< of each frame in the information matrix; −1: held, or not linked
  int track_column_ = -1;
  std::unique_ptr<SparseCovariance> inverse_;
};

/// 99.9 % of χ² with six degrees of freedom, and 99 % with six and three.
inline constexpr double chi_square_6_gate = 22.46, chi_square_6 = 16.81, chi_square_3 = 11.34;

}  // namespace roadstereo
