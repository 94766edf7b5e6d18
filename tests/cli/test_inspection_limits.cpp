// What a road without damage can have all the same: expected values in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "inspection_limits.hpp"

namespace roadstereo {
namespace {

using cli::RoadView;

/// 640×480 pixels, 500 px, 0.2 m: from 2 m above a road the disparity is 50 px.
StereoCalibration rig() {
  StereoCalibration rig;
  rig.focal_px = 500;
  rig.cx_px = 319.5;
  rig.cy_px = 239.5;
  rig.baseline_m = 0.2;
  rig.width = 640;
  rig.height = 480;
  return rig;
}

/// Of a camera that looks straight down a change δ of the disparity D is a depth h·δ / (D − δ).
TEST(InspectionLimits, LookingDownChangeOfDisparityIsDepth) {
  const double noise_px = 0.4;
  const double change = 5 * std::hypot(noise_px, 0.03);  // threshold_sigma, sub_pixel_bias_px
  const auto depth = cli::resolved_depth({{50, 0, 0}, 2, noise_px, 1}, rig(), {});
  ASSERT_TRUE(depth);
  EXPECT_NEAR(depth->depth_m, 2 * change / (50 - change), 1e-12);
  EXPECT_NEAR(depth->distance_m, 2, 1e-12);
  EXPECT_EQ(cli::limit_text(depth, noise_px, {}).substr(0, 36), "a depth or height of about 84 mm at ");
}

TEST(InspectionLimits, SmallestDepthOfOptionsHoldsWithoutNoise) {
  const auto depth = cli::resolved_depth({{50, 0, 0}, 2, 0, 1}, rig(), {.min_depth_m = 0.02});
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->depth_m, 0.02);
}

/// 45° below the horizon that optical axis meets the road at √2 h; the horizon is 500 px above it, out of the picture.
TEST(InspectionLimits, ObliqueCameraSeesMiddleOfRoad) {
  const double at_axis = 500 * 0.2 / (2 * std::numbers::sqrt2), per_row = at_axis / 500;
  const RoadView view{{at_axis - 239.5 * per_row, per_row, 0}, 2, 0.1, 1};
  const auto depth = cli::resolved_depth(view, rig(), {});
  ASSERT_TRUE(depth);
  EXPECT_NEAR(depth->distance_m, 2 * std::numbers::sqrt2, 1e-9);
}

TEST(InspectionLimits, WithoutHeightOrSizeDepthIsUnknown) {
  StereoCalibration sizeless = rig();
  sizeless.width = 0;
  EXPECT_FALSE(cli::resolved_depth({{50, 0, 0}, 2, 0.1, 1}, sizeless, {}));
  EXPECT_FALSE(cli::resolved_depth({{50, 0, 0}, std::nan(""), 0.1, 1}, rig(), {}));
  EXPECT_EQ(cli::limit_text(std::nullopt, 0.04, {}), "a change of the disparity by 0.25 px");  // 5·√(0.04² + 0.03²)
}

/// The horizon at row 240 of 480, or from corner to corner: half of the picture.
TEST(InspectionLimits, ShareBelowHorizon) {
  EXPECT_NEAR(cli::share_below_horizon({-24, 0.1, 0}, 640, 480), 0.5, 1e-9);
  EXPECT_NEAR(cli::share_below_horizon({0, 0.1, -0.1 * 480 / 640}, 640, 480), 0.5, 1e-3);
  EXPECT_EQ(cli::share_below_horizon({50, 0, 0}, 640, 480), 1);
  EXPECT_EQ(cli::share_below_horizon({-50, 0, 0}, 640, 480), 0);
}

TEST(InspectionLimits, FewDisparitiesOfRoadAreDoubt) {
  const DisparityPlane horizon_in_middle{-24, 0.1, 0};
  EXPECT_TRUE(cli::doubts_of({}, {horizon_in_middle, 2, 0.1, 0.3}, 640, 480).empty());
  EXPECT_EQ(cli::doubts_of({}, {horizon_in_middle, 2, 0.1, 0.2}, 640, 480).size(), 1U);
  HealthFinding finding{"row-error", 9, 0.5, "px", "the rows differ", true};
  EXPECT_EQ(cli::doubts_of({finding}), std::vector<std::string>{"the rows differ"});
  finding.spoils_depth = false;
  EXPECT_TRUE(cli::doubts_of({finding}).empty());
}

}  // namespace
}  // namespace roadstereo
