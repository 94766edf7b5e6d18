// What stands on the road: the scope, and what is given off the road.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "tests/pipeline/synthetic_truth.hpp"

namespace roadstereo {
namespace {

/// A street in which vehicles and houses fill half of the image, up to 26 px nearer than the road.
synth::SyntheticPair crowded_street() {
  synth::Scene s = synth::random_wide_scene(12);
  s.supersampling = 1;
  return synth::render(s);
}

TEST(PipelineScope, SceneMatchesWhatStandsOnRoad) {
  const synth::SyntheticPair pair = crowded_street();
  const auto wrong_or_missing = [&](Scope scope) {
    PipelineOptions options;
    options.perspective.scope = scope;
    Pipeline pipeline(options, pair.calibration);
    const test::Errors errors = test::compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair);
    return errors.missing + (1 - errors.missing) * errors.share_above_1px;
  };
  EXPECT_LT(wrong_or_missing(Scope::scene), 0.5 * wrong_or_missing(Scope::road));
}

/// The road has less weight where it is one surface of many.
TEST(PipelineScope, SceneHasWeakerRoadPrior) {
  const synth::SyntheticPair pair = crowded_street();
  const auto disparity = [&](double road_prior_truncation) {
    PipelineOptions options;
    options.perspective.scope = Scope::scene;
    options.coarse_search.road_prior_truncation = road_prior_truncation;
    Pipeline pipeline(options, pair.calibration);
    const Image<float>& map = pipeline.process(pair.left.view(), pair.right.view()).disparity;
    std::vector<std::uint32_t> bits(map.pixels());  // NaN differs from itself
    std::memcpy(bits.data(), map.row(0), bits.size() * sizeof(float));
    return bits;
  };
  EXPECT_EQ(disparity(1.5), disparity(0.3));
  EXPECT_NE(disparity(0.3), disparity(0));
}

/// With a limit that hardly anything meets: of a street, whose horizon is in the picture, and of a road from the air.
TEST(PipelineOffRoad, PictureWithoutHorizonKeepsEverything) {
  PipelineOptions options;
  options.off_road.max_sigma_px = 0.05;
  const auto missing = [&](const synth::SyntheticPair& pair) {
    Pipeline pipeline(options, pair.calibration);
    return test::compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair).missing;
  };
  EXPECT_GT(missing(crowded_street()), 0.3);
  EXPECT_LT(missing(test::named_pair("uav")), 0.01);
}

/// Share of what is given and wrong by more than 1 px.
double wrong_share(const synth::SyntheticPair& pair, double max_sigma_px) {
  PipelineOptions options;
  options.off_road.max_sigma_px = max_sigma_px;
  Pipeline pipeline(options, pair.calibration);
  return test::compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair).share_above_1px;
}

/// Of a street, whatever its standard error.
TEST(PipelineOffRoad, SearchOfSceneTellsVehiclesFromRoad) {
  const synth::SyntheticPair pair = crowded_street();
  const double checked = wrong_share(pair, 10), unchecked = wrong_share(pair, 0);
  RecordProperty("checked", std::to_string(checked));
  RecordProperty("unchecked", std::to_string(unchecked));
  EXPECT_LT(checked, 0.5 * unchecked);
}

/// A rig whose disparities are 60 px more: the horizon of the road is in the picture as before.
TEST(PipelineOffRoad, HorizonIsWhereDepthIsInfinite) {
  constexpr int offset_px = 60;
  synth::SyntheticPair pair = crowded_street();
  const int width = pair.right.width;
  std::vector<std::uint8_t> moved(pair.right.bytes.size());
  const auto channels = moved.size() / static_cast<std::size_t>(width * pair.right.height);
  for (int v = 0; v < pair.right.height; ++v) {
    for (int u = 0; u < width; ++u) {
      const int from = std::min(width - 1, u + offset_px);
      for (std::size_t c = 0; c < channels; ++c) {
        moved[static_cast<std::size_t>(v * width + u) * channels + c] =
            pair.right.bytes[static_cast<std::size_t>(v * width + from) * channels + c];
      }
    }
  }
  pair.right.bytes = moved;
  pair.calibration.disparity_offset_px = -offset_px;
  for (int v = 0; v < pair.disparity.height(); ++v) {
    for (int u = 0; u < width; ++u) pair.disparity(u, v) += offset_px;
  }
  EXPECT_LT(wrong_share(pair, 10), 0.9 * wrong_share(pair, 0));
}

}  // namespace
}  // namespace roadstereo
