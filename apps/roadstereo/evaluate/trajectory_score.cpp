#include "evaluate/trajectory_score.hpp"

#include "core/degrees.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
Eigen::Isometry3d isometry(const Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(pose.data());
  return result;
}

namespace {

std::vector<Eigen::Isometry3d> isometries(const std::vector<Pose>& poses) {
  std::vector<Eigen::Isometry3d> result;
  result.reserve(poses.size());
  for (const Pose& pose : poses) result.push_back(isometry(pose));
  return result;
}

std::vector<double> path_lengths(const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<double> lengths{0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths.push_back(lengths.back() + (poses[i].translation() - poses[i - 1].translation()).norm());
  }
  return lengths;
}

std::vector<double> piece_lengths(double path_m) {
  constexpr double short_path_m = 20;
  const double unit = path_m < short_path_m ? path_m / 10 : 10;
  return {unit, 2 * unit, 3 * unit, 4 * unit, 5 * unit};
}

/// Mean errors over the pieces.
void score_pieces(const std::vector<Eigen::Isometry3d>& truth, const std::vector<Eigen::Isometry3d>& estimate,
                  const std::vector<double>& path, TrajectoryScore& score) {
  double translation = 0, rotation = 0;
  for (const double length : piece_lengths(path.back())) {
    std::size_t last = 0;
    for (std::size_t first = 0; first < truth.size(); ++first) {
      while (last < truth.size() && path[last] < path[first] + length) ++last;
      if (last == truth.size()) break;
      const Eigen::Isometry3d error =
          (estimate[first].inverse() * estimate[last]).inverse() * (truth[first].inverse() * truth[last]);
      translation += error.translation().norm() / length;
      rotation += Eigen::AngleAxisd(error.rotation()).angle() / length;
      ++score.pieces;
    }
  }
  const double count = static_cast<double>(score.pieces);
  score.translation_percent = 100 * translation / count;
  score.rotation_deg_per_m = to_degrees(rotation / count);
}

/// Least squares of t − v × t over the translations of single motions, v small and without a part about z.
Eigen::Vector3d turn_between(const std::vector<Eigen::Isometry3d>& truth,
                             const std::vector<Eigen::Isometry3d>& estimate) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Vector3d t = (truth[i - 1].inverse() * truth[i]).translation();
    const Eigen::Vector3d difference = t - (estimate[i - 1].inverse() * estimate[i]).translation();
    Eigen::Matrix<double, 3, 2> row;
    row.col(0) = Eigen::Vector3d::UnitX().cross(t);
    row.col(1) = Eigen::Vector3d::UnitY().cross(t);
    normal += row.transpose() * row;
    right += row.transpose() * difference;
  }
  const Eigen::Vector2d turn = normal.ldlt().solve(right);
  return {turn.x(), turn.y(), 0};
}

/// Adds the turn and the error without it.
void score_turned(std::vector<Eigen::Isometry3d> truth, const std::vector<Eigen::Isometry3d>& estimate,
                  const std::vector<double>& path, TrajectoryScore& score) {
  const Eigen::Vector3d turn = turn_between(truth, estimate);
  score.axes_turn_rad = {turn.x(), turn.y()};
  if (turn.norm() > 0) {
    const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
    for (Eigen::Isometry3d& pose : truth) pose = pose * rotation;
  }
  TrajectoryScore turned;
  score_pieces(truth, estimate, path, turned);
  score.turned_percent = turned.translation_percent;
}

double absolute_error(const std::vector<Eigen::Isometry3d>& truth, const std::vector<Eigen::Isometry3d>& estimate) {
  const auto count = static_cast<Eigen::Index>(truth.size());
  Eigen::Matrix3Xd to(3, count), from(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    to.col(i) = truth[static_cast<std::size_t>(i)].translation();
    from.col(i) = estimate[static_cast<std::size_t>(i)].translation();
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd aligned = (motion.topLeftCorner<3, 3>() * from).colwise() + motion.topRightCorner<3, 1>();
  return std::sqrt((aligned - to).colwise().squaredNorm().mean());
}

}  // namespace

TrajectoryScore score_trajectory(const std::vector<Pose>& truth_poses, const std::vector<Pose>& estimated_poses) {
  if (truth_poses.size() != estimated_poses.size()) {
    fail("there are ", estimated_poses.size(), " estimated poses and ", truth_poses.size(), " true ones");
  }
  constexpr std::size_t min_frames = 3;
  if (truth_poses.size() < min_frames) fail("there are ", truth_poses.size(), " poses; there must be at least 3");
  const std::vector<Eigen::Isometry3d> truth = isometries(truth_poses), estimate = isometries(estimated_poses);
  const std::vector<double> path = path_lengths(truth);
  TrajectoryScore score;
  score.path_m = path.back();
  if (!(score.path_m > 0)) fail("the true path has no length");
  score_pieces(truth, estimate, path, score);
  score_turned(truth, estimate, path, score);
  score.absolute_percent = 100 * absolute_error(truth, estimate) / score.path_m;
  return score;
}

}  // namespace roadstereo::cli
