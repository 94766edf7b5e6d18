// What spoils the depths of a rig, and with them its severities, at the limits of every finding that does.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/health.hpp"

namespace roadstereo {
namespace {

/// The only finding of a rig; fails where there is none, or another.
HealthFinding only_finding(const PairHealth& health) {
  const std::vector<HealthFinding> all = health.findings();
  EXPECT_EQ(all.size(), 1U);
  EXPECT_EQ(health.depth_is_trusted(), all.empty() || !all[0].spoils_depth);
  return all.empty() ? HealthFinding{} : all[0];
}

TEST(PairHealth, DisparitiesBelowInfinitySpoilDepth) {
  PairHealth health;
  health.infinity_px = -1.01;
  const HealthFinding finding = only_finding(health);
  EXPECT_EQ(finding.id, "infinity");
  EXPECT_TRUE(finding.spoils_depth);
  EXPECT_DOUBLE_EQ(finding.value, 1.01);
  EXPECT_EQ(finding.limit, 1);
  // Less than the limit; trees and houses above the horizon; no view of the sky.
  for (const double infinity_px : {-0.99, 5.0, PairHealth::unknown}) {
    health.infinity_px = infinity_px;
    EXPECT_TRUE(health.findings().empty()) << infinity_px;
    EXPECT_TRUE(health.depth_is_trusted()) << infinity_px;
  }
}

// Found where it bends the road by more than its noise; as deep as a damage at the threshold, it spoils depth.
TEST(PairHealth, DistortionAsDeepAsDamageSpoilsDepth) {
  PairHealth health;
  health.noise_px = 0.05;
  health.bowl_px = 0.04;
  EXPECT_TRUE(health.findings().empty());
  health.bowl_px = 0.1;
  const HealthFinding shallow = only_finding(health);
  EXPECT_EQ(shallow.id, "distortion");
  EXPECT_FALSE(shallow.spoils_depth);
  EXPECT_EQ(shallow.value, 0.1);
  EXPECT_EQ(shallow.limit, 0.05);
  health.bowl_px = 0.3;  // the threshold is five times the noise
  EXPECT_TRUE(only_finding(health).spoils_depth);
  health.threshold_sigma = 7;
  EXPECT_FALSE(only_finding(health).spoils_depth);
  health.noise_px = PairHealth::unknown;
  EXPECT_TRUE(health.findings().empty());
}

// Signs are words, and what rounds to nothing is not told.
TEST(PairHealth, RowsAreToldWithoutSigns) {
  PairHealth health;
  health.row_error_px = 9.12;
  health.row_scale = -0.0002;
  health.row_turn_rad = -1e-6;
  health.row_offset_px = -4.58;
  EXPECT_EQ(only_finding(health).text,
            "the rows of the pair differ by up to 9.12 px (limit 0.5 px): the right view is 0.02 % smaller and 4.58 px "
            "higher; rectify the pair, with a new calibration of the rig");
  health.row_scale = 0.0008;
  health.row_turn_rad = 0.0204;  // 1.17°
  health.row_offset_px = 0.001;
  EXPECT_NE(only_finding(health).text.find(": the right view is 0.08 % larger and turned clockwise by 1.17°; rectify"),
            std::string::npos);
  health.row_offset_px = 3;
  EXPECT_NE(only_finding(health).text.find("0.08 % larger, turned clockwise by 1.17° and 3 px lower"),
            std::string::npos);
  health.row_scale = health.row_turn_rad = health.row_offset_px = PairHealth::unknown;
  EXPECT_NE(only_finding(health).text.find("(limit 0.5 px); rectify"), std::string::npos);
}

TEST(PairHealth, RowsAPixelApartSpoilDepth) {
  PairHealth health;
  health.row_error_px = 0.49;
  EXPECT_TRUE(health.findings().empty());
  health.row_error_px = 0.99;
  EXPECT_EQ(only_finding(health).id, "row-error");
  EXPECT_FALSE(only_finding(health).spoils_depth);
  health.row_error_px = 1.01;
  EXPECT_TRUE(only_finding(health).spoils_depth);
}

/// A road whose horizon is row 100 of 240, below a sky at infinity in which a tree takes half of the columns.
struct SkyFrame {
  static constexpr int width = 320, height = 240;
  static constexpr float doffs = 4;

  FrameResult frame;
  StereoCalibration calibration{.focal_px = 300, .cx_px = 159.5, .cy_px = 119.5, .baseline_m = 0.2};

  SkyFrame() {
    frame.roll_found = true;
    frame.grey = frame.right = GreyImage(width, height, 1600);
    frame.geometry.plane = {-0.2 * 100 - double{doffs}, 0.2, 0};
    frame.disparity.resize(width, height);
    frame.transformed.assign(width, height, 30);
    frame.sigma.assign(width, height, 0.1F);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const auto road = static_cast<float>(frame.geometry.plane.disparity(u, v));
        frame.disparity(u, v) = v >= 100 ? road : (u < width / 2 ? 3.0F : 0.0F) - doffs;
      }
    }
    calibration.disparity_offset_px = double{doffs};
  }

  PairHealth health() const { return measure_health(frame, make_empty_damage_map(width, height, ""), calibration); }
};

TEST(MeasureHealth, OffsetOfDisparitiesShowsInTheSky) {
  SkyFrame sky;
  EXPECT_EQ(sky.health().infinity_px, 0);
  EXPECT_TRUE(sky.health().depth_is_trusted());
  // Where a match is uncertain, or there is none, the disparities say nothing.
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < SkyFrame::width; ++u) {
      sky.frame.disparity(u, v) = -50;
      sky.frame.sigma(u, v) = v < 20 ? 0.31F : std::numeric_limits<float>::quiet_NaN();
    }
  }
  EXPECT_EQ(sky.health().infinity_px, 0);
  sky.calibration.disparity_offset_px -= 2;
  EXPECT_EQ(sky.health().infinity_px, -2);
  const HealthFinding finding = only_finding(sky.health());
  EXPECT_EQ(finding.id, "infinity");
  EXPECT_TRUE(finding.spoils_depth);
  // Two rows of the sky: one pixel in 4×4 is looked at, and 200 of them are needed.
  for (int v = 0; v < 95; ++v) {
    for (int u = 0; u < SkyFrame::width; ++u) sky.frame.disparity(u, v) = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_TRUE(std::isnan(sky.health().infinity_px));
}

}  // namespace
}  // namespace roadstereo
