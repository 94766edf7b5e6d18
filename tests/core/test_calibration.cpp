// Rectified calibrations: the pinhole equations, the road as a plane in space, and what is refused.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "roadstereo/calibration.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

StereoCalibration zed() {
  return {700, 640, 360, 0.12, 0, 1280, 720};
}

std::string refusal(const StereoCalibration& calibration, int width = 1280, int height = 720) {
  try {
    calibration.validate(width, height, "rig.yaml");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StereoCalibration, DepthAndPointFollowPinholeModel) {
  const StereoCalibration c = zed();
  EXPECT_DOUBLE_EQ(c.depth_m(42), 700 * 0.12 / 42);
  const auto p = c.point_m(990, 185, 42);
  EXPECT_NEAR(p[2], 2.0, 1e-12);
  EXPECT_NEAR(p[0], 1.0, 1e-12);   // (990 − 640) / 700 · 2
  EXPECT_NEAR(p[1], -0.5, 1e-12);  // (185 − 360) / 700 · 2
}

TEST(StereoCalibration, DisparityOffsetShiftsDepth) {
  StereoCalibration c = zed();
  c.disparity_offset_px = 8;
  EXPECT_DOUBLE_EQ(c.depth_m(34), 2.0);
}

TEST(StereoCalibration, RejectsInvalidFiguresByName) {
  EXPECT_EQ(refusal(zed()), "accepted");
  StereoCalibration c = zed();
  c.baseline_m = 60;
  EXPECT_EQ(refusal(c), "rig.yaml: the baseline is 60; it must be between 0.005 and 10 metres");
  c = zed();
  c.baseline_m = 0;
  EXPECT_NE(refusal(c).find("the baseline is 0"), std::string::npos);
  c = zed();
  c.focal_px = 3;
  EXPECT_NE(refusal(c).find("the focal length is 3"), std::string::npos);
  c = zed();
  c.cx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(c).find("principal point's column is nan"), std::string::npos);
  EXPECT_NE(refusal(zed(), 640, 360).find("1280×720"), std::string::npos);
}

// A camera at height h, pitched down by θ and rolled by ρ about its axis, over the plane Z = 0: derived with rotation
// matrices here, compared with the plane read off the disparity model.
TEST(GroundPlane, RoundTripsThroughDisparities) {
  const StereoCalibration c = zed();
  const double h = 2.5, pitch = 0.6, roll = 0.07;
  const double n[3] = {std::sin(roll) * std::cos(pitch), std::cos(roll) * std::cos(pitch), std::sin(pitch)};
  const auto disparity = [&](double u, double v) {
    const double x = (u - c.cx_px) / c.focal_px, y = (v - c.cy_px) / c.focal_px;
    const double z = h / (n[0] * x + n[1] * y + n[2]);
    return c.focal_px * c.baseline_m / z;
  };
  DisparityPlane model;
  model.a0 = disparity(0, 0);
  model.a1 = disparity(0, 1) - model.a0;
  model.a2 = disparity(1, 0) - model.a0;
  const GroundPlane plane = ground_plane(model, c);
  EXPECT_NEAR(plane.height_m, h, 1e-9);
  EXPECT_NEAR(plane.pitch_rad, pitch, 1e-9);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(plane.normal[i], n[i], 1e-9);
}

}  // namespace
}  // namespace roadstereo
