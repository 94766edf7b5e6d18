// The axes of the road as a camera above it sees them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A rig with an offset of the principal points, over a road seen at an angle and tilted sideways.
StereoCalibration tilted_rig() {
  return {500, 150.5, 99.5, 0.2, 3, 300, 200};
}
const DisparityPlane tilted_road{40, 0.1, 0.02};

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void expect_right_handed(const RoadAxes& frame) {
  for (const auto& axis : {frame.x, frame.y, frame.z}) EXPECT_NEAR(dot(axis, axis), 1, 1e-12);
  EXPECT_NEAR(dot(frame.x, frame.y), 0, 1e-12);
  EXPECT_NEAR(dot(frame.y, frame.z), 0, 1e-12);
  EXPECT_NEAR(dot(frame.z, frame.x), 0, 1e-12);
  const std::array<double, 3> cross{frame.x[1] * frame.y[2] - frame.x[2] * frame.y[1],
                                    frame.x[2] * frame.y[0] - frame.x[0] * frame.y[2],
                                    frame.x[0] * frame.y[1] - frame.x[1] * frame.y[0]};
  EXPECT_NEAR(dot(cross, frame.z), 1, 1e-12);
}

/// A camera over the road: pitch below the horizon, then rolled about its axis. The normal in the camera's frame is
/// (sin ψ·cos θ, cos ψ·cos θ, sin θ).
GroundPlane plane_of(double pitch, double roll, double height_m) {
  return {{std::sin(roll) * std::cos(pitch), std::cos(roll) * std::cos(pitch), std::sin(pitch)}, height_m, pitch};
}

TEST(RoadAxes, AreRightHandedWithZUp) {
  for (const double pitch : {90.0, 60.0, 30.0, 4.0, 0.5}) {
    for (const double roll : {0.0, 3.0, -20.0, 80.0}) {
      const GroundPlane plane = plane_of(pitch * degree, roll * degree, 1.6);
      const RoadAxes frame = road_axes(plane);
      expect_right_handed(frame);
      const auto camera = frame.to_road({0, 0, 0});
      EXPECT_NEAR(camera[0], 0, 1e-12);
      EXPECT_NEAR(camera[1], 0, 1e-12);
      EXPECT_NEAR(camera[2], 1.6, 1e-12) << "the camera stands above the road";
      EXPECT_GT(frame.x[0], 0) << "to the camera's right";
      const std::array<double, 3> ray{0.1, 0.3, 1};
      const double z = plane.height_m / dot(plane.normal, ray);
      EXPECT_NEAR(frame.to_road({z * ray[0], z * ray[1], z})[2], 0, 1e-12);
    }
  }
}

TEST(RoadAxes, MatchNadirAndStreetByHand) {
  const RoadAxes nadir = road_axes(plane_of(90 * degree, 0, 2));
  const auto seen = nadir.to_road({0.3, 0.5, 1.9});  // right of the middle, below it, 10 cm above the road
  EXPECT_NEAR(seen[0], 0.3, 1e-12);
  EXPECT_NEAR(seen[1], -0.5, 1e-12);
  EXPECT_NEAR(seen[2], 0.1, 1e-12);
  const RoadAxes level = road_axes(plane_of(0, 0, 1.5));  // looks at the horizon
  const auto ahead = level.to_road({-2, 1.4, 20});
  EXPECT_NEAR(ahead[0], -2, 1e-12);
  EXPECT_NEAR(ahead[1], 20, 1e-12);
  EXPECT_NEAR(ahead[2], 0.1, 1e-12);
  const RoadAxes slanted = road_axes(plane_of(35 * degree, 0, 1.5));
  const auto axis = slanted.to_road({0, 0, 1.5 / std::sin(35 * degree)});  // where the optical axis meets the road
  EXPECT_NEAR(axis[0], 0, 1e-12);
  EXPECT_NEAR(axis[1], 1.5 / std::tan(35 * degree), 1e-12);
  EXPECT_NEAR(axis[2], 0, 1e-12);
}

TEST(RoadAxes, PointsOfDisparityModelLieOnRoad) {
  const GroundPlane plane = ground_plane(tilted_road, tilted_rig());
  const RoadAxes frame = road_axes(plane);
  expect_right_handed(frame);
  for (const auto& [u, v] : {std::array{0.0, 0.0}, std::array{299.0, 10.0}, std::array{140.0, 199.0}}) {
    const auto point = frame.to_road(tilted_rig().point_m(u, v, tilted_road.disparity(u, v)));
    EXPECT_NEAR(point[2], 0, 1e-12);
  }
}

/// Straight down from 2 m, f = 600 px, b = 0.1 m: d = 30 px. A tenth of a pixel is 2 m / 300; over the standard
/// deviation of the rows it tilts by 0.1/138.6 px a row, 600/30 times that in radians, and so do the columns.
TEST(GroundPlane, ErrorOfDeviatingSurface) {
  const StereoCalibration rig{600, 319.5, 239.5, 0.1};  // as of files without a size
  const GroundPlaneError error = ground_plane_error({30, 0, 0}, rig, 640, 480, 0.1);
  EXPECT_NEAR(error.height_m, 2.0 / 300, 0.01 * 2 / 300);
  EXPECT_NEAR(error.pitch_rad, std::hypot(0.1 * std::sqrt(12.0) / 480 * 20, 0.1 * std::sqrt(12.0) / 640 * 20), 1e-4);
  EXPECT_EQ(ground_plane_error({30, 0, 0}, rig, 640, 480, 0).height_m, 0);
}

}  // namespace
}  // namespace roadstereo
