// A cloud finds its place on a scan: synthetic surfaces under known motions, and scores that are known by hand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "evaluate/rigid_registration.hpp"
#include "evaluate/scan_score.hpp"
#include "roadstereo/error.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::cli;

constexpr double degree = std::numbers::pi / 180;

/// A pothole that no turn maps onto itself, millimetres: how deep it is at (x, y), which lie within 40 mm of its
/// middle.
double depth_at(double x, double y) {
  const double bowl = 40 * std::exp(-(x * x / 500 + y * y / 900));
  return bowl + 6 * std::sin(x / 9 + 0.5) * std::cos(y / 13) + 0.1 * x + 0.02 * x * y / 10;
}

bool is_inside(double x, double y) {
  return x * x / (36 * 36) + y * y / (42 * 42) < 1 + 0.2 * std::sin(3 * std::atan2(y, x) + 0.4);
}

/// The scan: a regular grid without noise.
Points make_scan(double step) {
  Points points;
  const int count = static_cast<int>(50 / step);
  for (int i = -count; i <= count; ++i) {
    for (int j = -count; j <= count; ++j) {
      const double x = i * step, y = j * step;
      if (is_inside(x, y)) points.emplace_back(x, y, depth_at(x, y));
    }
  }
  return points;
}

struct Spoiling {
  double noise_mm = 0;
  double outlier_share = 0;
};

/// Other points of the same surface, seen after a motion; outliers lie up to 40 mm off it.
Points make_cloud(const RigidMotion& motion, std::size_t count, const Spoiling& spoiling) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-50, 50), share(0, 1);
  std::normal_distribution<double> noise(0, 1);
  Points points;
  while (points.size() < count) {
    const double x = place(random), y = place(random);
    if (!is_inside(x, y)) continue;
    Eigen::Vector3d point(x, y, depth_at(x, y));
    for (int axis = 0; axis < 3; ++axis) point[axis] += spoiling.noise_mm * noise(random);
    if (share(random) < spoiling.outlier_share) point[2] += 40 * (share(random) - 0.3);
    points.push_back(motion(point));
  }
  return points;
}

RigidMotion make_motion(double angle_deg, const Eigen::Vector3d& axis, const Eigen::Vector3d& shift) {
  return {Eigen::AngleAxisd(angle_deg * degree, axis.normalized()).toRotationMatrix(), shift};
}

/// Turn and shift between what was found and the inverse of what was applied.
void expect_inverse(const RigidMotion& found, const RigidMotion& applied, double max_degrees, double max_mm) {
  const Eigen::Matrix3d left_over = found.rotation * applied.rotation;
  EXPECT_NEAR(left_over.determinant(), 1, 1e-9);
  EXPECT_LT(Eigen::AngleAxisd(left_over).angle() / degree, max_degrees);
  const Eigen::Vector3d middle(0, 0, 20);
  EXPECT_LT((found(applied(middle)) - middle).norm(), max_mm);
}

TEST(SlowRegistration, RecoversMotionDespiteNoiseAndOutliers) {
  const ScanModel scan(make_scan(0.5));
  const RigidMotion motions[] = {make_motion(0, {0, 0, 1}, {0, 0, 0}), make_motion(180, {1, 0.2, 0}, {3, -800, 900}),
                                 make_motion(140, {0.1, 0.2, 1}, {-200, 50, 700}),
                                 make_motion(95, {1, -1, 0.7}, {1e4, 2e4, -3e3})};
  for (const RigidMotion& motion : motions) {
    const Points cloud = make_cloud(motion, 20000, {0.5, 0.2});
    const Registration found = register_cloud(cloud, scan);
    expect_inverse(found.motion, motion, 0.1, 0.2);
    EXPECT_GT(found.next_rms, 2 * found.rms);
  }
}

/// Noise of s on every axis leaves s along the normal; the closest point of a grid of 0.5 mm is up to 0.35 mm aside.
TEST(Registration, CleanPointsLieOnScan) {
  const ScanModel scan(make_scan(0.5));
  const RigidMotion motion = make_motion(200, {0.3, 1, 0.2}, {100, 200, 300});
  const Points cloud = make_cloud(motion, 5000, {});
  for (const LastStep last : {LastStep::robust, LastStep::least_squares}) {
    const Registration found = register_cloud(cloud, scan, last);
    expect_inverse(found.motion, motion, 0.05, 0.1);
    const ScanScore score = score_distances(closest_distances(cloud, scan, found.motion), 10000);
    EXPECT_LT(score.rms_mm, 0.4);
    EXPECT_NEAR(score.rms_or_missing_mm, std::sqrt(0.5 * score.rms_mm * score.rms_mm + 0.5 * 100), 1e-9);
    EXPECT_NEAR(score.completeness(), 0.5, 1e-12);
  }
}

TEST(Registration, NeverReflects) {
  const ScanModel scan(make_scan(0.5));
  Points mirrored = make_cloud({}, 5000, {});
  for (Eigen::Vector3d& point : mirrored) point[0] = -point[0];
  const Registration found = register_cloud(mirrored, scan);
  EXPECT_NEAR(found.motion.rotation.determinant(), 1, 1e-9);
  EXPECT_GT(found.rms, 0.5);  // the surface is not its own mirror image
}

/// A surface that half a turn maps onto itself has two poses that fit alike.
TEST(Registration, NextPoseIsMeasuredAsTheBestOne) {
  Points points;
  for (double x = -40; x <= 40; x += 0.5) {
    for (double y = -30; y <= 30; y += 0.5)
      points.emplace_back(x, y, 40 * std::exp(-(x * x / 500 + y * y / 900)) + x * y / 60);
  }
  const ScanModel scan(points);
  for (const LastStep last : {LastStep::robust, LastStep::least_squares}) {
    const Registration found = register_cloud(subsample_evenly(points, 4000), scan, last);
    EXPECT_NEAR(found.next_rms, found.rms, 0.02) << found.rms;
  }
}

TEST(Registration, IsDeterministic) {
  const ScanModel scan(make_scan(1));
  const Points cloud = make_cloud(make_motion(33, {1, 2, 3}, {5, 5, 5}), 3000, {0.5, 0.1});
  const Registration one = register_cloud(cloud, scan), other = register_cloud(cloud, scan);
  EXPECT_EQ(one.motion.rotation, other.motion.rotation);
  EXPECT_EQ(one.motion.translation, other.motion.translation);
}

TEST(Registration, RejectsBadInput) {
  const ScanModel scan(make_scan(1));
  EXPECT_THROW(register_cloud(make_cloud({}, 99, {}), scan), Error);
  EXPECT_THROW(ScanModel(Points(5, Eigen::Vector3d::Zero())), Error);
}

TEST(ScanModel, PointsBeyondRimAreNotCovered) {
  const ScanModel scan(make_scan(0.5));
  EXPECT_TRUE(scan.covers({0, 0, depth_at(0, 0) + 2}));
  EXPECT_TRUE(scan.covers({10, -12, depth_at(10, -12) - 2}));
  EXPECT_FALSE(scan.covers({70, 0, depth_at(70, 0)}));
  EXPECT_FALSE(scan.covers({0, -60, depth_at(0, -60)}));
}

TEST(ScanScore, MatchesFiguresByHand) {
  const std::vector<ScanDistance> distances{{3, true}, {4, true}, {0, true}, {5, false}};
  const ScanScore score = score_distances(distances, 5);
  EXPECT_NEAR(score.rms_mm, std::sqrt(50.0 / 4), 1e-12);
  EXPECT_NEAR(score.rms_covered_mm, std::sqrt(25.0 / 3), 1e-12);
  EXPECT_NEAR(score.rms_or_missing_mm, std::sqrt(150.0 / 5), 1e-12);
  EXPECT_NEAR(score.median_mm, 3.5, 1e-12);
  EXPECT_NEAR(score.p99_mm, 5, 1e-12);
  EXPECT_NEAR(score.completeness(), 0.8, 1e-12);
  EXPECT_EQ(score.covered, 3U);
  EXPECT_THROW(score_distances(distances, 3), Error);
  EXPECT_THROW(score_distances({}, 3), Error);
}

}  // namespace
