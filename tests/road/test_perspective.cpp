// The perspective transformation: the shift itself, its inverse, the common view, and the choice of δp and D.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/perspective.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

RoadModelEstimate reliable(const DisparityPlane& model, double lowest = -3, double highest = 2) {
  RoadModelEstimate estimate;
  estimate.model = model;
  estimate.status = RoadStatus::found;
  estimate.residual_p01_px = lowest;
  estimate.residual_p99_px = highest;
  return estimate;
}

PerspectiveShift shift_by(const DisparityPlane& road, double delta_p, bool whole_pixel = false) {
  PerspectiveShift shift;
  shift.road = road;
  shift.delta_p = delta_p;
  shift.disparities = 16;
  shift.whole_pixel = whole_pixel;
  return shift;
}

TEST(PerspectiveShift, IsRoadMinusDeltaPAndNotNegative) {
  const PerspectiveShift shift = shift_by({-10, 0.25, 0.01}, 4);
  EXPECT_NEAR(shift.at(100, 200), -10 + 50 + 1 - 4, 1e-12);
  EXPECT_EQ(shift.at(0, 20), 0);                                  // above the horizon
  EXPECT_EQ(shift_by({-10, 0.25, 0}, 4.4, true).at(0, 201), 36);  // 35.85
}

// A target painted with a known road: after the transformation every road pixel must sit δp left of its place in the
// reference image, whatever the sub-pixel shift of its row.
TEST(TransformTarget, MovesRoadToDeltaP) {
  const DisparityPlane road{8.3, 0.137, 0.011};
  const auto pair = test::textured_pair(220, 90, [&](double u, double v) { return road.disparity(u, v); });
  const PerspectiveShift shift = shift_by(road, 5);
  GreyImage transformed;
  std::vector<int> first;
  transform_target(pair.target, shift, 2, transformed, first);
  double squares = 0;
  int count = 0;
  for (int v = 0; v < 90; ++v) {
    EXPECT_NEAR(first[static_cast<std::size_t>(v)], (road.disparity(0, v) - 5) / (1 - road.a2), 1.0);
    // Reference pixel u shows what target pixel u − d(u) shows. Its place in the transformed row, x, solves
    // x − shift(x) = u − d(u), so that u − x = δp / (1 − a2) everywhere on the road.
    const double k = 5 / (1 - road.a2);
    for (int x = first[static_cast<std::size_t>(v)] + 2; x + 7 < 220; ++x) {
      const int base = static_cast<int>(x + k);
      const double f = x + k - base;
      const double expected = pair.reference(base, v) * (1 - f) + pair.reference(base + 1, v) * f;
      squares += std::pow(transformed(x, v) - expected, 2);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 3.0 * grey_scale);  // linear against cubic interpolation of the texture
}

TEST(TransformTarget, ZeroShiftIsIdentity) {
  const auto pair = test::textured_pair(70, 40, [](double, double) { return 3; });
  PerspectiveShift shift;
  shift.enabled = false;
  GreyImage transformed;
  std::vector<int> first;
  transform_target(pair.target, shift, 1, transformed, first);
  EXPECT_EQ(transformed, pair.target);
  for (const int column : first) EXPECT_EQ(column, 0);
}

TEST(TransformTarget, WholePixelShiftCopiesPixels) {
  const auto pair = test::textured_pair(120, 40, [](double, double) { return 3; });
  const PerspectiveShift shift = shift_by({10, 0.3, 0}, 2, true);
  GreyImage transformed;
  std::vector<int> first;
  transform_target(pair.target, shift, 1, transformed, first);
  for (int v = 0; v < 40; ++v) {
    const int s = static_cast<int>(std::lround(8 + 0.3 * v));
    EXPECT_EQ(first[static_cast<std::size_t>(v)], s);
    for (int x = s; x < 120; ++x) ASSERT_EQ(transformed(x, v), pair.target(x - s, v));
  }
}

/// A target that changes along v alone, as a polynomial that takes whole values at whole and half rows.
GreyImage by_rows(int height, double (*grey)(double)) {
  GreyImage image(40, height);
  for (int v = 0; v < height; ++v) std::fill_n(image.row(v), 40, static_cast<std::int16_t>(std::lround(grey(v))));
  return image;
}

// Keys' cubic interpolation reproduces polynomials of the second degree.
TEST(TransformTarget, UndoesRowOffsetOfQuadraticTexture) {
  constexpr int height = 30;
  double (*const textures[])(double) = {[](double v) { return 200 + 20 * v; }, [](double v) { return 4 * v * v; },
                                        [](double v) { return 3900 - 30 * v - 2 * v * (v + 0.5); }};
  for (const auto grey : textures) {
    const GreyImage target = by_rows(height, grey);
    for (const double offset : {0.5, -0.5, 1.5, -2.0, 0.0}) {
      SCOPED_TRACE(offset);
      PerspectiveShift shift = shift_by({6.25, 0.1, 0}, 2);
      shift.misalignment.rows_px = offset;
      GreyImage transformed;
      std::vector<int> first;
      transform_target(target, shift, 2, transformed, first);
      for (int v = 4; v + 4 < height; ++v) {
        for (int x = first[static_cast<std::size_t>(v)]; x < 40; ++x) ASSERT_EQ(transformed(x, v), grey(v + offset));
      }
    }
  }
}

// The grey levels are a linear function of the place, which cubic interpolation reproduces.
TEST(TransformTarget, UndoesTurnAndRowScale) {
  constexpr int width = 60, height = 40;
  const auto grey = [](double u, double v) { return 200 + 7 * u + 20 * v; };
  GreyImage target(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) target(u, v) = static_cast<std::int16_t>(std::lround(grey(u, v)));
  }
  for (const double turn : {0.01, -0.01, 0.0}) {
    for (const double scale : {0.0, 0.005}) {
      SCOPED_TRACE(turn);
      PerspectiveShift shift = shift_by({3, 0.05, 0.02}, 0);
      shift.misalignment = {0.4, turn, scale, 30, 20};
      GreyImage transformed;
      std::vector<int> first;
      transform_target(target, shift, 2, transformed, first);
      for (int v = 6; v + 6 < height; ++v) {
        for (int x = first[static_cast<std::size_t>(v)] + 4; x + 4 < width; ++x) {
          const double ideal = x - (3 + 0.05 * v + 0.02 * x);
          // A turn by θ moves (x, y) from the principal point by (−θ y, θ x), a scale s of the rows by (0, s y).
          const double column = ideal - turn * (v - 20);
          const double row = v + 0.4 + turn * (ideal - 30) + scale * (v - 20);
          ASSERT_NEAR(transformed(x, v), grey(column, row), 0.6) << x << ", " << v;
        }
      }
    }
  }
}

// Eight pixels at the corner of a 61×41 image, whose centre is the principal point: |turn|·30 for rows.
TEST(TransformTarget, RefusesMisalignmentBeyondItsBorder) {
  const GreyImage target(61, 41);
  GreyImage transformed;
  std::vector<int> first;
  PerspectiveShift shift;
  shift.misalignment = {0, 7.9 / 30, 0, 30, 20};
  EXPECT_NO_THROW(transform_target(target, shift, 1, transformed, first));
  for (const Misalignment& beyond : {Misalignment{0, -8.1 / 30, 0, 30, 20}, Misalignment{8.1, 0, 0, 30, 20},
                                     Misalignment{0, 0, 8.1 / 20, 30, 20}, Misalignment{std::nan(""), 0, 0, 30, 20}}) {
    shift.misalignment = beyond;
    EXPECT_THROW(transform_target(target, shift, 1, transformed, first), Error);
  }
}

TEST(TransformTarget, WholeRowOffsetCopiesRows) {
  constexpr int height = 40;
  const auto pair = test::textured_pair(70, height, [](double, double) { return 3; });
  for (const int offset : {1, -2}) {
    PerspectiveShift shift;
    shift.enabled = false;
    shift.misalignment.rows_px = offset;
    GreyImage transformed;
    std::vector<int> first;
    transform_target(pair.target, shift, 1, transformed, first);
    for (int v = 0; v < height; ++v) {
      const int row = std::clamp(v + offset, 0, height - 1);
      ASSERT_TRUE(std::equal(transformed.row(v), transformed.row(v) + 70, pair.target.row(row))) << v;
    }
  }
}

TEST(AddShift, UndoesTransformation) {
  const PerspectiveShift shift = shift_by({12.25, 0.31, -0.02}, 6);
  Image<float> residual(50, 30, 2.5F), disparity;
  residual(7, 7) = std::numeric_limits<float>::quiet_NaN();
  restore_disparity(residual, shift, 1, 2, disparity);
  // The target column that was matched, x = u − k, came from column x − shift(x) of the target: d = u − that.
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 50; ++u) {
      if (u == 7 && v == 7) continue;
      const double x = u - 2.5;
      const double source = x - (12.25 + 0.31 * v - 0.02 * x - 6);
      EXPECT_NEAR(disparity(u, v), u - source, 1e-4);
    }
  }
  EXPECT_TRUE(std::isnan(disparity(7, 7)));
}

TEST(PlanPerspective, ConvertsPhysicalLimitsToPixels) {
  // Straight down from 2 m: f·b/h = 700·0.12/2 = 42 px everywhere.
  const StereoCalibration rig{700, 319.5, 179.5, 0.12, 0, 640, 360};
  PerspectiveOptions options;
  options.max_damage_depth_m = 0.25;
  options.max_bump_height_m = 0.20;
  const PerspectiveShift shift = plan_perspective(reliable({42, 0, 0}, 0, 0), rig, 640, 360, options);
  const double deepest = 42 - 700 * 0.12 / 2.25;  // disparity lost by a floor 25 cm lower: 4.67 px
  const double highest = 700 * 0.12 / 1.8 - 42;   // gained by a bump of 20 cm: 4.67 px
  EXPECT_GE(shift.delta_p, deepest);
  EXPECT_LE(shift.delta_p, deepest + 3);
  EXPECT_GE(shift.disparities - 1, shift.delta_p + highest);
  EXPECT_LE(shift.disparities - 1, shift.delta_p + highest + 3);
  EXPECT_NEAR(shift.camera_height_m, 2, 1e-12);
}

TEST(PlanPerspective, WithoutScaleUsesResidualsOfMatches) {
  const PerspectiveShift shift =
      plan_perspective(reliable({42, 0, 0}, -7.5, 3.5), std::nullopt, 640, 360, PerspectiveOptions{});
  EXPECT_EQ(shift.delta_p, 10);      // 7.5 + 2 rounded up
  EXPECT_EQ(shift.disparities, 17);  // 10 + 5.5 rounded up + 1
}

/// Few of the matches that the road is found with lie in a pothole.
TEST(PlanPerspective, WithoutScaleSearchesDamageBelowCameraOfUsualHeight) {
  const PerspectiveShift shift =
      plan_perspective(reliable({320, 0, 0}, 0, 0), std::nullopt, 2080, 1040, PerspectiveOptions{});
  EXPECT_EQ(shift.camera_height_m, 1.5);
  EXPECT_GE(shift.delta_p, 320 - 320 * 1.5 / 1.6);  // 20 px at 10 cm, and 29 mm under a camera at arm's length, 0.45 m
  EXPECT_LE(shift.delta_p, 320 - 320 * 1.5 / 1.6 + 3);
  EXPECT_GE(shift.disparities - 1, shift.delta_p + 320 * 1.5 / 1.45 - 320);
}

TEST(PlanPerspective, SceneSearchesUpToLargestDisparity) {
  PerspectiveOptions options;
  options.scope = Scope::scene;
  // Above the horizon, v < 20, the residual is the disparity itself, and δp more below it.
  RoadModelEstimate road = reliable({-10, 0.5, 0}, -1, 1);
  road.max_disparity_px = 100;
  const PerspectiveShift shift = plan_perspective(road, std::nullopt, 640, 360, options);
  EXPECT_EQ(shift.at(0, 0), 0);
  EXPECT_GE(shift.disparities - 1, 100);
  EXPECT_LE(shift.disparities - 1, 100 * 1.1 + 8 + shift.delta_p + 3);
  road.max_disparity_px = 0;  // unknown, as when the road is tracked: a quarter of the width
  EXPECT_GE(plan_perspective(road, std::nullopt, 640, 360, options).disparities, 160);
  options.scope = Scope::road;
  const double nearest = -10 + 0.5 * 359, of_damage = nearest * (0.1 / 1.6 + 0.05 / 1.45);  // below 1.5 m
  EXPECT_LE(plan_perspective(road, std::nullopt, 640, 360, options).disparities, of_damage + 8);
}

TEST(PlanPerspective, TakesGivenPixels) {
  PerspectiveOptions options;
  options.disparities = 33;
  options.delta_p_px = 12;
  const PerspectiveShift shift = plan_perspective(reliable({42, 0.1, 0}), std::nullopt, 640, 360, options);
  EXPECT_EQ(shift.disparities, 33);
  EXPECT_EQ(shift.delta_p, 12);
}

TEST(PlanPerspective, UnreliableRoadSearchesFullRange) {
  RoadModelEstimate poor;
  poor.model = {42, 0.1, 0};
  poor.matches = 500;
  poor.max_disparity_px = 80;
  const PerspectiveShift shift = plan_perspective(poor, std::nullopt, 640, 360, PerspectiveOptions{});
  EXPECT_FALSE(shift.enabled);
  EXPECT_EQ(shift.at(300, 300), 0);
  EXPECT_GE(shift.disparities, 80);
}

/// 200 columns have 199 disparities.
TEST(PlanPerspective, RefusesRoadBeyondSearchedDisparities) {
  RoadModelEstimate road;
  road.status = RoadStatus::found;
  road.model = {2, 0.2, 0};
  PerspectiveOptions options;
  options.delta_p_px = 198;
  EXPECT_EQ(plan_perspective(road, std::nullopt, 200, 100, options).disparities, 199);
  options.delta_p_px = 199;
  EXPECT_THROW(plan_perspective(road, std::nullopt, 200, 100, options), Error);
}

// Disparities are at least 8 and less than the width: the range was upside down in images of 8 columns.
TEST(PlanPerspective, RefusesSmallImagesAndOptionsOutOfRange) {
  const auto message = [](int width, int height, const PerspectiveOptions& options) -> std::string {
    try {
      plan_perspective(RoadModelEstimate{}, std::nullopt, width, height, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  PerspectiveOptions options;
  EXPECT_EQ(message(32, 32, options), "accepted");
  EXPECT_NE(message(8, 32, options).find("8×32"), std::string::npos) << message(8, 32, options);
  EXPECT_NE(message(0, 0, options).find("0×0"), std::string::npos) << message(0, 0, options);
  options.max_damage_depth_m = -1;
  EXPECT_NE(message(640, 360, options).find("perspective.max_damage_depth_m is -1"), std::string::npos)
      << message(640, 360, options);
}

TEST(PerspectiveOptions, RejectsValuesOutOfRange) {
  PerspectiveOptions options;
  options.disparities = 1025;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.max_damage_depth_m = 0;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.max_bump_height_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.disparities = 8;
  options.delta_p_px = 8;
  EXPECT_THROW(options.validate(), Error) << "the road is not searched";
  options.delta_p_px = 7;
  EXPECT_NO_THROW(options.validate());
}

}  // namespace
}  // namespace roadstereo
