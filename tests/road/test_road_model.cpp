// The road model from images alone, against exact synthetic planes; and what happens when there is no evidence.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"
#include "roadstereo/road_model.hpp"
#include "roadstereo/synth.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

struct Pair {
  GreyImage left, right;
  synth::SyntheticPair truth;
};

synth::Scene scene(const std::string& name) {
  synth::Scene named = synth::named_scene(name);
  named.supersampling = 1;
  return named;
}

Pair render_pair(const synth::Scene& scene) {
  Pair pair;
  pair.truth = synth::render(scene);
  to_grey(pair.truth.left.view(), 0, pair.left);
  to_grey(pair.truth.right.view(), 0, pair.right);
  return pair;
}

Pair render_scene(const std::string& name) {
  return render_pair(scene(name));
}

/// Largest difference of two models over the part of the image where the truth sees the road.
double worst_difference(const DisparityPlane& model, const synth::SyntheticPair& truth) {
  double worst = 0;
  for (int v = 0; v < truth.disparity.height(); ++v) {
    for (int u = 0; u < truth.disparity.width(); ++u) {
      if (std::isnan(truth.disparity(u, v))) continue;
      const double difference = std::abs(model.disparity(u, v) - truth.plane.disparity(u, v));
      if (std::isnan(difference) || difference > worst) worst = difference;
    }
  }
  return worst;
}

class RoadModelScene : public testing::TestWithParam<const char*> {};

TEST_P(RoadModelScene, IsWithinHalfPixelOfTruth) {
  const Pair pair = render_scene(GetParam());
  for (const bool calibrated : {true, false}) {
    const auto calibration = calibrated ? std::optional(pair.truth.calibration) : std::nullopt;
    const RoadModelEstimate road = estimate_road_model(pair.left, pair.right, calibration, RoadModelOptions{});
    ASSERT_TRUE(road.has_road()) << road.reason;
    EXPECT_LT(worst_difference(road.model, pair.truth), 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, RoadModelScene,
                         testing::Values("flat", "uav", "nadir", "demo", "rolled", "noise", "blur", "gain"),
                         [](const auto& test) { return std::string(test.param); });

/// Bars at the sides of both pictures match where they stand, at a disparity of 0.
TEST(RoadModel, BlackBarsTakeNoPart) {
  Pair pair = render_scene("uav");
  const int bar = pair.left.width() / 8;
  for (GreyImage* const view : {&pair.left, &pair.right}) {
    for (int v = 0; v < view->height(); ++v) {
      std::fill_n(view->row(v), bar, std::int16_t{0});
      std::fill_n(view->row(v) + view->width() - bar, bar, std::int16_t{0});
    }
  }
  const RoadModelEstimate road = estimate_road_model(pair.left, pair.right, pair.truth.calibration, RoadModelOptions{});
  ASSERT_TRUE(road.has_road()) << road.reason;
  EXPECT_LT(worst_difference(road.model, pair.truth), 0.5);
}

TEST(DisparityPlane, CarriesOverToNextFrame) {
  const Pair first = render_scene("uav");
  const RoadModelEstimate start =
      estimate_road_model(first.left, first.right, first.truth.calibration, RoadModelOptions{});
  ASSERT_TRUE(start.has_road());
  const Pair second = render_pair(synth::next_frame(scene("uav"), 1));
  const RoadModelEstimate next = verify_road_model(second.left, second.right, {start.model, start.inlier_share},
                                                   second.truth.calibration, RoadModelOptions{});
  EXPECT_TRUE(next.has_road()) << next.reason;
  EXPECT_EQ(next.status, RoadStatus::tracked);
  EXPECT_LT(worst_difference(next.model, second.truth), 0.5);
}

TEST(DisparityPlane, JumpIsUnreliable) {
  const DisparityPlane before = render_scene("uav").truth.plane;
  synth::Scene lower = scene("uav");
  lower.rig.camera_height_m *= 0.5;
  const Pair jumped = render_pair(lower);
  const RoadModelEstimate lost =
      verify_road_model(jumped.left, jumped.right, {before, 0.9}, jumped.truth.calibration, RoadModelOptions{});
  EXPECT_FALSE(lost.has_road());
  EXPECT_FALSE(lost.reason.empty());
}

TEST(DisparityPlane, UnrelatedImagesAreUnreliable) {
  // Two unrelated pictures.
  const auto a = test::textured_pair(
      320, 200, [](double, double) { return 0; }, 1);
  const auto b = test::textured_pair(
      320, 200, [](double, double) { return 0; }, 99);
  const RoadModelEstimate road = estimate_road_model(a.reference, b.reference, std::nullopt, RoadModelOptions{});
  EXPECT_FALSE(road.has_road());
  EXPECT_FALSE(road.reason.empty());
}

/// A sixth of the light in pictures of 8 bits: the texture is some grey levels strong, which the means of the shrunk
/// images keep.
TEST(DisparityPlane, DarkRoadHasEvidenceOfBrightOne) {
  const Pair bright = render_scene("uav");
  const auto darkened = [](const GreyImage& image) {
    GreyImage dark(image.width(), image.height());
    for (int v = 0; v < image.height(); ++v) {
      for (int u = 0; u < image.width(); ++u) {
        const double level = static_cast<double>(image(u, v)) / grey_scale;
        dark(u, v) = static_cast<std::int16_t>(grey_scale * std::lround(level / 6));
      }
    }
    return dark;
  };
  const auto evidence_of = [&](const GreyImage& left, const GreyImage& right) {
    return estimate_road_model(left, right, bright.truth.calibration, RoadModelOptions{}).evidence;
  };
  const double expected = evidence_of(bright.left, bright.right);
  EXPECT_GT(expected, 0.3);
  EXPECT_GT(evidence_of(darkened(bright.left), darkened(bright.right)), 0.8 * expected);
}

/// A drone over a bent road in noise: seven single blocks are reliable.
TEST(DisparityPlane, EvidenceFindsRoadThatHardlyAnyBlockShows) {
  synth::Scene wide = synth::random_wide_scene(39);
  wide.supersampling = 1;
  wide.road.camber = 0.03;
  wide.road.crest = 0.02;
  wide.road.texture_contrast *= 0.5;
  wide.degradation.noise_grey = 5;
  const Pair pair = render_pair(wide);
  const RoadModelEstimate road = estimate_road_model(pair.left, pair.right, pair.truth.calibration, RoadModelOptions{});
  EXPECT_LT(road.matches, 40);
  ASSERT_TRUE(road.has_road()) << road.reason;
  EXPECT_GT(road.evidence, 0.1);
  double worst = 0;  // of the bent road itself: measured 0.84
  for (int v = 0; v < pair.truth.disparity.height(); ++v) {
    for (int u = 0; u < pair.truth.disparity.width(); ++u) {
      if (pair.truth.road(u, v) == 0) continue;
      const double error = std::abs(road.model.disparity(u, v) - pair.truth.disparity(u, v));
      if (std::isnan(error) || error > worst) worst = error;
    }
  }
  EXPECT_LT(worst, 1.05);
}

TEST(DisparityPlane, WithoutRollDependsOnRowAlone) {
  const Pair pair = render_scene("flat");
  RoadModelOptions options;
  options.with_roll = false;
  const RoadModelEstimate road = estimate_road_model(pair.left, pair.right, pair.truth.calibration, options);
  ASSERT_TRUE(road.has_road()) << road.reason;
  EXPECT_EQ(road.model.a2, 0);
}

TEST(DisparityPlane, RejectsSwappedImages) {
  const Pair pair = render_scene("uav");
  try {
    estimate_road_model(pair.right, pair.left, pair.truth.calibration, RoadModelOptions{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("left and right look swapped"), std::string::npos);
  }
}

TEST(DisparityPlane, AcceptsSmallestImages) {
  const auto pair = test::textured_pair(32, 32, [](double, double) { return 4; });
  EXPECT_NO_THROW(estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{}));
}

TEST(RoadModelOptions, RejectsValuesOutOfRange) {
  RoadModelOptions options;
  options.max_disparity_share = 0;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.max_road_tilt_deg = 90;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.min_evidence = -1;
  EXPECT_THROW(options.validate(), Error);
}

}  // namespace
}  // namespace roadstereo
