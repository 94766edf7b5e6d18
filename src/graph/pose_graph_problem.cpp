#include "graph/pose_graph_problem.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6>;
constexpr int pose_size = 6;

/// Distance from an expected value in standard errors.
template <int N>
struct PriorResidual {
  Eigen::Matrix<double, N, 1> weights;

  template <class T>
  bool operator()(const T* value, T* residual) const {
    for (int i = 0; i < N; ++i) residual[i] = weights[i] * value[i];
    return true;
  }
};

template <int N>
ceres::CostFunction* prior(const Eigen::Matrix<double, N, 1>& weights) {
  return new ceres::AutoDiffCostFunction<PriorResidual<N>, N, N>(new PriorResidual<N>{weights});
}

}  // namespace

Covariance covariance_of(const FrameLink& link) {
  constexpr double least_sd_m = 1e-6, least_sd_rad = 1e-7;
  Covariance covariance = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(link.covariance.data());
  covariance.diagonal().head<3>().array() += least_sd_m * least_sd_m;
  covariance.diagonal().tail<3>().array() += least_sd_rad * least_sd_rad;
  return covariance;
}

PoseGraphProblem::PoseGraphProblem(std::vector<GraphPose>& poses, TrackUnknowns& track) : poses_(poses), track_(track) {
  for (GraphPose& pose : poses_) {
    problem_.AddParameterBlock(pose.position.data(), 3);
    problem_.AddParameterBlock(pose.rotation.coeffs().data(), 4, new ceres::EigenQuaternionManifold);
  }
}

void PoseGraphProblem::add_link(std::size_t from, std::size_t to, const FrameLink& link, bool is_loop) {
  auto* const residual = new LinkResidual(graph_pose(link.motion), covariance_of(link));
  const double scale = std::sqrt(chi_square_6);
  ceres::LossFunction* const loss =
      is_loop ? static_cast<ceres::LossFunction*>(new ceres::CauchyLoss(scale)) : new ceres::HuberLoss(scale);
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<LinkResidual, 6, 3, 4, 3, 4>(residual), loss,
                            poses_[from].position.data(), poses_[from].rotation.coeffs().data(),
                            poses_[to].position.data(), poses_[to].rotation.coeffs().data());
}

void PoseGraphProblem::add_fix(std::size_t frame, const FixResidual& residual, double count) {
  auto* const loss =
      new ceres::ScaledLoss(new ceres::CauchyLoss(std::sqrt(chi_square_3)), 1 / count, ceres::TAKE_OWNERSHIP);
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<FixResidual, 3, 3, 4, 3, 3, 1>(new FixResidual(residual)),
                            loss, poses_[frame].position.data(), poses_[frame].rotation.coeffs().data(),
                            track_.lever_arm.data(), track_.fix_error.data(), &track_.time_offset_s);
}

void PoseGraphProblem::add_level(std::size_t frame, const Eigen::Vector3d& up, double weight) {
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<LevelResidual, 2, 4>(new LevelResidual(up, weight)),
                            nullptr, poses_[frame].rotation.coeffs().data());
}

void PoseGraphProblem::add_track_prior(const Eigen::Vector3d& fix_error_sd, double lever_arm_sd, double time_offset_sd,
                                       double max_time_offset_s) {
  constexpr double least_s = 1e-6;
  time_offset_sd = std::min(time_offset_sd, std::max(max_time_offset_s, least_s));
  const Eigen::Vector3d lever = Eigen::Vector3d::Constant(1 / lever_arm_sd);
  problem_.AddResidualBlock(prior<3>(fix_error_sd.cwiseInverse()), nullptr, track_.fix_error.data());
  problem_.AddResidualBlock(prior<3>(lever), nullptr, track_.lever_arm.data());
  problem_.AddResidualBlock(prior<1>(Eigen::Matrix<double, 1, 1>(1 / time_offset_sd)), nullptr, &track_.time_offset_s);
  if (max_time_offset_s == 0) return;
  problem_.SetParameterLowerBound(&track_.time_offset_s, 0, -max_time_offset_s);
  problem_.SetParameterUpperBound(&track_.time_offset_s, 0, max_time_offset_s);
}

void PoseGraphProblem::hold(std::size_t frame) {
  problem_.SetParameterBlockConstant(poses_[frame].position.data());
  problem_.SetParameterBlockConstant(poses_[frame].rotation.coeffs().data());
}

void PoseGraphProblem::hold_time_offset() {
  problem_.SetParameterBlockConstant(&track_.time_offset_s);
}

void PoseGraphProblem::hold_lever_arm(const std::vector<int>& axes) {
  if (axes.empty()) return;
  double* const lever_arm = track_.lever_arm.data();
  if (axes.size() == 3) return problem_.SetParameterBlockConstant(lever_arm);
  problem_.SetManifold(lever_arm, new ceres::SubsetManifold(3, axes));
}

void PoseGraphProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // SuiteSparse calls a BLAS, which has threads
  options.num_threads = 1;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-9;
  options.parameter_tolerance = 0;  // relative to the positions: far from the origin it would end the solution early
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  if (!summary.IsSolutionUsable()) fail("the pose graph cannot be solved: ", summary.message);
}

void PoseGraphProblem::linearise() {
  ceres::Problem::EvaluateOptions options;
  options.num_threads = 1;
  columns_.assign(poses_.size(), -1);
  int column = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    double* const position = poses_[i].position.data();
    if (problem_.IsParameterBlockConstant(position)) continue;
    options.parameter_blocks.push_back(position);
    options.parameter_blocks.push_back(poses_[i].rotation.coeffs().data());
    columns_[i] = column;
    column += pose_size;
  }
  if (problem_.HasParameterBlock(track_.lever_arm.data())) {
    track_column_ = column;
    problem_.SetParameterBlockVariable(&track_.time_offset_s);
    problem_.SetParameterBlockVariable(track_.lever_arm.data());
    problem_.SetManifold(track_.lever_arm.data(), nullptr);
    options.parameter_blocks.insert(options.parameter_blocks.end(),
                                    {track_.lever_arm.data(), &track_.time_offset_s, track_.fix_error.data()});
  }
  if (options.parameter_blocks.empty()) return inverse_.reset();
  ceres::CRSMatrix rows;
  problem_.Evaluate(options, nullptr, nullptr, nullptr, &rows);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(), rows.cols.data(),
      rows.values.data());
  inverse_ = std::make_unique<SparseCovariance>(Eigen::SparseMatrix<double>(jacobian.transpose() * jacobian));
}

/// Derivative of a pose's error in the axes of its camera by its parameters. Those of the rotation are half a rotation
/// vector in the world.
Covariance PoseGraphProblem::to_camera(std::size_t frame) const {
  const Eigen::Matrix3d turn = poses_[frame].rotation.toRotationMatrix().transpose();
  Covariance result = Covariance::Zero();
  result.topLeftCorner<3, 3>() = turn;
  result.bottomRightCorner<3, 3>() = 2 * turn;
  return result;
}

Covariance PoseGraphProblem::covariance(std::size_t frame) {
  if (columns_[frame] < 0) return Covariance::Zero();
  const Covariance turn = to_camera(frame);
  return turn * inverse_->block(columns_[frame], pose_size) * turn.transpose();
}

Covariance PoseGraphProblem::relative_covariance(std::size_t from, std::size_t to) const {
  // exp(ξ) of the motion from → to: ξ = error of `to` − Ad · error of `from`.
  const GraphPose motion = inverse(poses_[to]) * poses_[from];
  const Eigen::Matrix3d turn = motion.rotation.toRotationMatrix();
  Covariance adjoint = Covariance::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = turn;
  for (int i = 0; i < 3; ++i) adjoint.block<3, 1>(0, 3 + i) = motion.position.cross(turn.col(i));
  std::vector<Eigen::Triplet<double>> elements;
  const auto add = [&](std::size_t frame, const Covariance& block) {
    if (columns_[frame] < 0) return;
    for (int i = 0; i < pose_size; ++i) {
      for (int j = 0; j < pose_size; ++j) elements.emplace_back(i, columns_[frame] + j, block(i, j));
    }
  };
  add(to, to_camera(to));
  add(from, -adjoint * to_camera(from));
  if (elements.empty()) return Covariance::Zero();
  Eigen::SparseMatrix<double> jacobian(pose_size, inverse_->size());
  jacobian.setFromTriplets(elements.begin(), elements.end());
  return inverse_->of(jacobian);
}

Eigen::Vector4d PoseGraphProblem::track_deviations() {
  return inverse_->block(track_column_, 4).diagonal().cwiseSqrt();
}

}  // namespace roadstereo
