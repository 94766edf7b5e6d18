// Errors of trajectories whose errors are known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluate/trajectory_score.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// Position z after `scale` · i metres, turned by `yaw` about y.
std::vector<Pose> straight(double scale, double yaw = 0, int frames = 61) {
  std::vector<Pose> poses;
  const double s = std::sin(yaw), c = std::cos(yaw);
  for (int i = 0; i < frames; ++i) poses.push_back({c, 0, s, s * scale * i, 0, 1, 0, 2, -s, 0, c, c * scale * i});
  return poses;
}

TEST(TrajectoryScore, ScaleErrorIsThatPercentage) {
  const TrajectoryScore score = score_trajectory(straight(1), straight(1.01));
  EXPECT_NEAR(score.path_m, 60, 1e-9);
  EXPECT_NEAR(score.translation_percent, 1, 1e-9);
  EXPECT_NEAR(score.rotation_deg_per_m, 0, 1e-9);
  EXPECT_EQ(score.pieces, 51U + 41 + 31 + 21 + 11);
  // Centred: 0.01 m times the standard deviation of 0 … 60, √((61² − 1) / 12), of 60 m.
  EXPECT_NEAR(score.absolute_percent, 100 * 0.01 * std::sqrt((61.0 * 61 - 1) / 12) / 60, 1e-9);
}

TEST(TrajectoryScore, OtherWorldFrameIsNoError) {
  const TrajectoryScore score = score_trajectory(straight(0.1), straight(0.1, 1.1));
  EXPECT_NEAR(score.translation_percent, 0, 1e-9);
  EXPECT_NEAR(score.rotation_deg_per_m, 0, 1e-6);
  EXPECT_NEAR(score.absolute_percent, 0, 1e-9);
}

// Poses of a sensor that is turned against the camera by 4 mrad about x and 3 mrad about y: the direction of every
// motion is off by 5 mrad, which is 0.5 % of any piece.
TEST(TrajectoryScore, TurnOfTruthIsFoundAndTakenOut) {
  const std::vector<Pose> estimate = straight(1);
  std::vector<Pose> truth;
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.004, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.003, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  for (const Pose& pose : estimate) {
    Eigen::Isometry3d turned = isometry(pose);
    turned.linear() = turned.linear() * turn.transpose();
    Pose row{};
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.data()) = turned.matrix().topRows<3>();
    truth.push_back(row);
  }
  const TrajectoryScore score = score_trajectory(truth, estimate);
  EXPECT_NEAR(score.translation_percent, 0.5, 0.001);
  EXPECT_NEAR(score.axes_turn_rad[0], 0.004, 2e-5);
  EXPECT_NEAR(score.axes_turn_rad[1], 0.003, 2e-5);
  EXPECT_LT(score.turned_percent, 0.002);
  // An error of scale is none of direction.
  EXPECT_NEAR(score_trajectory(straight(1), straight(1.01)).turned_percent, 1, 1e-6);
}

TEST(TrajectoryScore, RotationIsPerMetre) {
  // A camera that stays on its path but turns by 0.02° a metre too much.
  const std::vector<Pose> truth = straight(1);
  std::vector<Pose> turned = truth;
  constexpr double per_m = 0.02;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const double yaw = per_m * static_cast<double>(i) * std::numbers::pi / 180;
    const double s = std::sin(yaw), c = std::cos(yaw), z = truth[i][11];
    turned[i] = {c, 0, s, 0, 0, 1, 0, 2, -s, 0, c, z};
  }
  EXPECT_NEAR(score_trajectory(truth, turned).rotation_deg_per_m, per_m, 1e-9);
}

TEST(TrajectoryScore, RejectsWhatHasNoPath) {
  EXPECT_THROW(score_trajectory(straight(1), straight(1, 0, 60)), Error);
  EXPECT_THROW(score_trajectory(straight(1, 0, 2), straight(1, 0, 2)), Error);
  EXPECT_THROW(score_trajectory(straight(0), straight(0)), Error);
}

}  // namespace
}  // namespace roadstereo::cli
