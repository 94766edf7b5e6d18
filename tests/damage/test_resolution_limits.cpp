// What a rig can tell apart, against closed forms and rendered roads.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/resolution_limits.hpp"
#include "roadstereo/synth.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

constexpr double degree = std::numbers::pi / 180;

StereoCalibration example_rig() {
  StereoCalibration rig;
  rig.focal_px = 500;
  rig.cx_px = 319.5;
  rig.cy_px = 179.5;
  rig.baseline_m = 0.12;
  rig.width = 640;
  rig.height = 360;
  return rig;
}

/// f·b = 60 px·m: from 2 m the road is at 30 px; one pixel is Z²/(f·b) of depth but for the next order.
TEST(ResolutionLimits, NadirMatchesClosedForm) {
  ResolutionOptions options;
  options.noise_px = 0.04;
  const ResolutionLimits limits(example_rig(), {2.0, 90 * degree}, options);
  const auto rows = limits.rows(5);
  ASSERT_EQ(rows.size(), 5U);
  for (const RowResolution& row : rows) {
    EXPECT_NEAR(row.disparity_px, 30, 1e-9);
    EXPECT_NEAR(row.step_m, 2.0 / 29, 1e-12);
    // √(0.04² + 0.03²) px = 0.05 px; five of them 0.25 px.
    EXPECT_NEAR(row.std_error_m, 2 * 2 / 60.0 * 0.05, 1e-12);
    EXPECT_NEAR(row.resolvable_depth_m, 2 * 0.25 / 29.75, 1e-12);
    EXPECT_NEAR(row.gsd_across_m, 2.0 / 500, 1e-12);
    EXPECT_NEAR(row.gsd_along_m, 2.0 / 500, 1e-12);
    EXPECT_NEAR(row.swath_m, 610 * 2.0 / 500, 1e-9);
    EXPECT_NEAR(row.resolvable_area_m2, std::numbers::pi / 4 * 25 * 13 * 0.004 * 0.004, 1e-12);
    EXPECT_NEAR(row.ahead_m, (179.5 - row.row_px) * 0.004, 1e-9);
  }
  EXPECT_NEAR(limits.depth_m(100, 1e-4), 4 / 60.0 * 1e-4, 1e-9);
  EXPECT_TRUE(std::isinf(limits.depth_m(100, 30)));
}

/// A rut of 0.6 m × 3 m covers 1.8 m² / (π/4·25·13·(4 mm)²) = 440.7 windows: noise of 0.6/√440.7 = 0.02858 px, with the
/// bias 0.04143 px, five of which are 0.2072 px.
TEST(ResolutionLimits, RutAveragesNoiseButNotBias) {
  ResolutionOptions options;
  options.noise_px = 0.6;
  options.rut_width_m = 0.6;
  options.rut_length_m = 3;
  const RowResolution row = ResolutionLimits(example_rig(), {2.0, 90 * degree}, options).at_row(100);
  EXPECT_NEAR(row.resolvable_rut_m, 2 * 0.2072 / (30 - 0.2072), 1e-5);
  EXPECT_NEAR(row.resolvable_depth_m, 2 * 3.003748 / (30 - 3.003748), 1e-5);
}

/// The figure of a damage is that of the same rig, pose and noise.
TEST(ResolutionLimits, IsThatOfFindDamage) {
  const ExactMaps& maps = damaged();
  const DamageMap found = find_damage(maps.metric());
  ResolutionOptions options;
  options.noise_px = found.noise_px;
  const synth::Rig rig = damaged_scene().rig;
  const ResolutionLimits limits(maps.pair.calibration, {rig.camera_height_m, rig.pitch_deg * degree}, options);
  ASSERT_EQ(found.damages.size(), 2U);
  for (const Damage& damage : found.damages) {
    const double predicted = limits.at_row(damage.centroid_px[1]).resolvable_depth_m;
    EXPECT_NEAR(damage.metrics->resolvable_depth_m, predicted, 0.2 * predicted);
  }
}

TEST(ResolutionLimits, AreaIsAtLeastMinimumOfSegmentation) {
  ResolutionOptions options;
  options.min_area_m2 = 0.02;
  EXPECT_EQ(ResolutionLimits(example_rig(), {2.0, 90 * degree}, options).at_row(0).resolvable_area_m2, 0.02);
}

/// 45° and the principal row: Z = h·√2, as far ahead as high, and a metre along the ray is 1/√2 along the normal.
TEST(ResolutionLimits, FortyFiveDegreesMatchesClosedForm) {
  StereoCalibration rig = example_rig();
  rig.disparity_offset_px = 7;
  const ResolutionLimits limits(rig, {3.0, 45 * degree});
  const RowResolution row = limits.at_row(179.5);
  const double z = 3 * std::numbers::sqrt2;
  EXPECT_NEAR(row.distance_m, z, 1e-12);
  EXPECT_NEAR(row.ahead_m, 3, 1e-12);
  EXPECT_NEAR(row.disparity_px, 60 / z - 7, 1e-12);
  EXPECT_NEAR(row.std_error_m, z * z / 60 * std::hypot(0.07, 0.03) / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(row.gsd_across_m, z / 500, 1e-12);
  const double difference = limits.at_row(179).ahead_m - limits.at_row(180).ahead_m;
  EXPECT_NEAR(row.gsd_along_m, difference, 1e-5 * difference);
}

/// The disparity of the road is that of the road's plane elsewhere in the library.
TEST(ResolutionLimits, AgreesWithRoadPlane) {
  const StereoCalibration rig = example_rig();
  const ResolutionLimits limits(rig, {1.7, 35 * degree});
  const double near = limits.at_row(300).disparity_px, far = limits.at_row(200).disparity_px;
  const double a1 = (near - far) / 100;
  const GroundPlane plane = ground_plane({near - 300 * a1, a1, 0}, rig);
  EXPECT_NEAR(plane.height_m, 1.7, 1e-9);
  EXPECT_NEAR(plane.pitch_rad, 35 * degree, 1e-9);
}

/// A flat-bottomed pothole in a rendered road: its depth from the change of the true disparity alone.
TEST(ResolutionLimits, RenderedPotholeHasPredictedDepth) {
  for (const double pitch : {90.0, 50.0, 30.0}) {
    synth::Scene scene;
    scene.rig.pitch_deg = pitch;
    scene.rig.camera_height_m = 1.5;
    scene.supersampling = 1;
    const double ahead = 1.5 / std::tan(pitch * degree);
    scene.road.blobs = {{0, ahead, 0.3, 0.06, 0, 0.02, 1}};
    scene.road.camber = 0;
    const synth::SyntheticPair pair = synth::render(scene);
    const ResolutionLimits limits(pair.calibration, {1.5, pitch * degree});
    const int u = scene.rig.width / 2, v = scene.rig.height / 2;
    ASSERT_NE(pair.labels(u, v), 0);
    EXPECT_NEAR(limits.at_row(v).disparity_px, pair.plane.disparity(u, v), 1e-6);
    const double change = pair.plane.disparity(u, v) - pair.disparity(u, v);
    EXPECT_GT(change, 0.5);
    EXPECT_NEAR(limits.depth_m(v, change), 0.06, 1e-4) << "pitch " << pitch;
  }
}

TEST(ResolutionLimits, FarthestRowReachesDepth) {
  const ResolutionLimits limits(example_rig(), {1.5, 25 * degree});
  const auto farthest = limits.farthest(0.05);
  ASSERT_TRUE(farthest);
  EXPECT_NEAR(farthest->resolvable_depth_m, 0.05, 1e-4);
  EXPECT_LE(farthest->resolvable_depth_m, 0.05);
  EXPECT_FALSE(limits.farthest(0.001));
  const auto everywhere = ResolutionLimits(example_rig(), {2.0, 90 * degree}).farthest(0.1);
  ASSERT_TRUE(everywhere);
  EXPECT_EQ(everywhere->row_px, 0);
}

TEST(ResolutionLimits, HighestCameraReachesDepthInMiddleRow) {
  const double highest = ResolutionLimits(example_rig(), {2.0, 60 * degree}).max_camera_height_m(0.025);
  const ResolutionLimits there(example_rig(), {highest, 60 * degree});
  EXPECT_NEAR(there.at_row(179.5).resolvable_depth_m, 0.025, 1e-9);
}

TEST(ResolutionLimits, RejectsBadInput) {
  const StereoCalibration rig = example_rig();
  EXPECT_THROW(ResolutionLimits(rig, {0, 1}), Error);
  EXPECT_THROW(ResolutionLimits(rig, {-1, 1}), Error);
  EXPECT_THROW(ResolutionLimits(rig, {2, 91 * degree}), Error);
  EXPECT_THROW(ResolutionLimits(rig, {2, std::nan("")}), Error);
  EXPECT_THROW(ResolutionLimits(rig, {2, -30 * degree}), Error);  // the sky alone
  EXPECT_NO_THROW(ResolutionLimits(rig, {2, -10 * degree}));      // road in the lower rows
  ResolutionOptions options;
  options.noise_px = -1;
  EXPECT_THROW(ResolutionLimits(rig, {2, 1}, options), Error);
  StereoCalibration sizeless = rig;
  sizeless.width = sizeless.height = 0;
  EXPECT_THROW(ResolutionLimits(sizeless, {2, 1}), Error);
}

}  // namespace
}  // namespace roadstereo
