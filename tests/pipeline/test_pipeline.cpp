// The whole way through on synthetic roads with exact truth, for every preset.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "roadstereo/warning.hpp"

namespace roadstereo {
namespace {

synth::SyntheticPair scene(const std::string& name) {
  synth::Scene s = synth::named_scene(name);
  s.supersampling = 1;
  return synth::render(s);
}

/// Errors against the truth where both cameras see the road.
struct Errors {
  double median = 0;
  double share_above_1px = 0;  ///< of the pixels that have a disparity
  double missing = 0;          ///< share of the pixels that have none
};

Errors compare(const Image<float>& disparity, const synth::SyntheticPair& truth) {
  std::vector<double> errors;
  double seen = 0, wrong = 0;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      if (truth.visible(u, v) == 0 || std::isnan(truth.disparity(u, v))) continue;
      seen += 1;
      if (std::isnan(disparity(u, v))) continue;
      errors.push_back(std::abs(disparity(u, v) - truth.disparity(u, v)));
      wrong += errors.back() > 1;
    }
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return {errors[errors.size() / 2], wrong / static_cast<double>(errors.size()),
          1 - static_cast<double>(errors.size()) / seen};
}

/// How much worse than measured a figure may become, and a share of pixels that rounding alone may change.
constexpr double slack = 1.25;
constexpr double rounded = 1e-4;

void expect_measured(const Errors& errors, const Errors& measured) {
  testing::Test::RecordProperty("median_px", std::to_string(errors.median));
  testing::Test::RecordProperty("share_above_1px", std::to_string(errors.share_above_1px));
  testing::Test::RecordProperty("missing", std::to_string(errors.missing));
  EXPECT_LE(errors.median, slack * measured.median);
  EXPECT_LE(errors.share_above_1px, std::max(rounded, slack * measured.share_above_1px));
  EXPECT_LE(errors.missing, std::max(rounded, slack * measured.missing));
}

struct PresetFigures {
  const char* preset;
  Errors errors;
  double roll_rad, sigma_road_px;  ///< error of ψ, spread of the transformed road
  double depth_px;                 ///< error of the mean depth of the demo's potholes
};

/// A street in which vehicles and houses fill half of the image, up to 26 px nearer than the road.
synth::SyntheticPair street() {
  synth::Scene s = synth::random_wide_scene(12);
  s.supersampling = 1;
  return synth::render(s);
}

TEST(PipelineScope, SceneMatchesWhatStandsOnRoad) {
  const synth::SyntheticPair pair = street();
  const auto wrong_or_missing = [&](Scope scope) {
    PipelineOptions options;
    options.perspective.scope = scope;
    Pipeline pipeline(options, pair.calibration);
    const Errors errors = compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair);
    return errors.missing + (1 - errors.missing) * errors.share_above_1px;
  };
  EXPECT_LT(wrong_or_missing(Scope::scene), 0.5 * wrong_or_missing(Scope::road));
}

/// The road has less weight where it is one surface of many.
TEST(PipelineScope, SceneHasWeakerRoadPrior) {
  const synth::SyntheticPair pair = street();
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
    return compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair).missing;
  };
  EXPECT_GT(missing(street()), 0.3);
  EXPECT_LT(missing(scene("uav")), 0.01);
}

/// What is given of a street and wrong by more than 1 px, whatever its standard error.
TEST(PipelineOffRoad, SearchOfSceneTellsVehiclesFromRoad) {
  const synth::SyntheticPair pair = street();
  const auto wrong = [&](double max_sigma_px) {
    PipelineOptions options;
    options.off_road.max_sigma_px = max_sigma_px;
    Pipeline pipeline(options, pair.calibration);
    return compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair).share_above_1px;
  };
  const double checked = wrong(10), unchecked = wrong(0);
  RecordProperty("checked", std::to_string(checked));
  RecordProperty("unchecked", std::to_string(unchecked));
  EXPECT_LT(checked, 0.5 * unchecked);
}

/// A rig whose disparities are 60 px more: the horizon of the road is in the picture as before.
TEST(PipelineOffRoad, HorizonIsWhereDepthIsInfinite) {
  constexpr int offset_px = 60;
  synth::SyntheticPair pair = street();
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
  const auto wrong = [&](double max_sigma_px) {
    PipelineOptions options;
    options.off_road.max_sigma_px = max_sigma_px;
    Pipeline pipeline(options, pair.calibration);
    return compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair).share_above_1px;
  };
  EXPECT_LT(wrong(10), 0.9 * wrong(0));
}

class PipelinePreset : public testing::TestWithParam<PresetFigures> {};

TEST_P(PipelinePreset, MatchesRoadFromAir) {
  const synth::SyntheticPair pair = scene("uav");
  Pipeline pipeline(preset(GetParam().preset), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  expect_measured(compare(result.disparity, pair), GetParam().errors);
  EXPECT_TRUE(result.road.has_road());
  const double roll_error = std::abs(result.geometry.roll_rad - pair.roll_rad);
  RecordProperty("roll_rad", std::to_string(roll_error));
  RecordProperty("road_px", std::to_string(result.spread.sigma_road_px));
  EXPECT_LE(roll_error, slack * GetParam().roll_rad);
  EXPECT_LE(result.spread.sigma_road_px, slack * GetParam().sigma_road_px);
}

TEST_P(PipelinePreset, PotholesLieBelowRoadInTransformedMap) {
  const synth::SyntheticPair pair = scene("demo");
  Pipeline pipeline(preset(GetParam().preset), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  // Mean depth, in pixels of disparity, of what lies well below the road's plane in the truth.
  double expected = 0, measured = 0, count = 0;
  for (int v = 0; v < pair.disparity.height(); ++v) {
    for (int u = 0; u < pair.disparity.width(); ++u) {
      const double below = pair.plane.disparity(u, v) - pair.disparity(u, v);
      if (pair.labels(u, v) == 0 || pair.visible(u, v) == 0 || std::isnan(result.transformed(u, v))) continue;
      if (below < 0.4) continue;
      expected += below;
      measured += result.delta_t - result.transformed(u, v);
      count += 1;
    }
  }
  ASSERT_GT(count, 500);
  const double error = std::abs(measured - expected) / count;
  RecordProperty("depth_px", std::to_string(error));
  EXPECT_LE(error, slack * GetParam().depth_px);
}

// `paper` shifts by whole pixels, which leaves a saw-tooth of up to half a pixel.
INSTANTIATE_TEST_SUITE_P(Presets, PipelinePreset,
                         testing::Values(PresetFigures{"default", {0.00585, 0, 0}, 0.00069, 0.0704, 0.0759},
                                         PresetFigures{"fast", {0.0235, 0, 0.00111}, 0.00081, 0.0694, 0.0901},
                                         PresetFigures{"paper", {0.0675, 0, 0}, 0.00034, 0.174, 0.126}),
                         [](const auto& test) { return std::string(test.param.preset); });

/// Masks the lower third, from a row on that is not matched: what is interpolated between has no σ either.
Image<std::uint8_t> lower_third(int width, int height) {
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 2 * height / 3 | 1; v < height; ++v) std::fill_n(mask.row(v), width, std::uint8_t{255});
  return mask;
}

TEST(PipelineMask, MaskedPixelsHaveNeitherDisparityNorDamage) {
  const synth::SyntheticPair pair = scene("demo");
  const Image<std::uint8_t> mask = lower_third(pair.left.width, pair.left.height);
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  Pipeline pipeline(options, pair.calibration);
  const auto damaged = [&pipeline](ImageView<const std::uint8_t> inside) {
    const DamageMap damage = pipeline.find_damage();
    int pixels = 0;
    for (int v = 0; v < inside.height(); ++v) {
      for (int u = 0; u < inside.width(); ++u) pixels += inside(u, v) != 0 && damage.ids(u, v) != 0;
    }
    return pixels;
  };
  pipeline.process(pair.left.view(), pair.right.view());
  ASSERT_GT(damaged(mask), 0);
  pipeline.reset();
  pipeline.set_mask(mask);
  for (const RoadStatus status : {RoadStatus::found, RoadStatus::tracked}) {
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status, status);
    std::size_t masked = 0, known = 0;
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        if (mask(u, v) == 0) {
          known += !std::isnan(result.disparity(u, v));
          continue;
        }
        masked += std::isnan(result.disparity(u, v)) && std::isnan(result.sigma(u, v)) &&
                  std::isnan(result.transformed(u, v));
      }
    }
    EXPECT_EQ(masked, static_cast<std::size_t>(std::count(mask.row(0), mask.row(0) + mask.pixels(), 255)));
    EXPECT_GT(known, (mask.pixels() - masked) * 9 / 10);
    EXPECT_EQ(damaged(mask), 0);
    // Damages are numbered by their order, and ids are those of damages.
    const DamageMap damage = pipeline.find_damage();
    std::vector<std::size_t> pixels(damage.damages.size() + 1);
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        ASSERT_LT(damage.ids(u, v), pixels.size());
        ++pixels[damage.ids(u, v)];
      }
    }
    for (std::size_t k = 0; k < damage.damages.size(); ++k) {
      EXPECT_EQ(damage.damages[k].id, static_cast<int>(k) + 1);
      EXPECT_GT(2 * pixels[k + 1], damage.damages[k].pixels);
    }
    EXPECT_LT(std::abs(result.geometry.roll_rad - pair.roll_rad), 0.006);
  }
  pipeline.set_mask({});
  pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_GT(damaged(mask), 0);
}

// What lies under a mask, a dark or a bright bonnet, tells nothing of the pothole that it cuts.
TEST(PipelineMask, GreyUnderMaskHasNoInfluence) {
  synth::SyntheticPair pair = scene("demo");
  const int width = pair.left.width, height = pair.left.height;
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  const auto damages_under = [&](const Image<std::uint8_t>& mask, const std::optional<std::uint8_t>& grey) {
    Frame left = pair.left;
    const std::size_t channels = left.bytes.size() / static_cast<std::size_t>(width * height);
    for (int v = 0; v < height && grey; ++v) {
      for (int u = 0; u < width; ++u) {
        if (mask(u, v) == 0) continue;
        std::fill_n(left.bytes.begin() + static_cast<std::ptrdiff_t>(v * width + u) * std::ptrdiff_t(channels),
                    channels, *grey);
      }
    }
    Pipeline pipeline(options, pair.calibration);
    pipeline.set_mask(mask);
    pipeline.process(left.view(), pair.right.view());
    return pipeline.find_damage().damages;
  };
  Pipeline whole(options, pair.calibration);
  whole.process(pair.left.view(), pair.right.view());
  const DamageMap damage = whole.find_damage();
  ASSERT_FALSE(damage.damages.empty());
  const auto& box = damage.damages[0].box_px;
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = box[3] - (box[3] - box[1]) / 5; v < height; ++v) std::fill_n(mask.row(v), width, std::uint8_t{255});
  for (const int grey : {20, 90, 250}) {
    const std::vector<Damage> found = damages_under(mask, static_cast<std::uint8_t>(grey));
    const auto cut = std::find_if(found.begin(), found.end(), [&](const Damage& each) {
      return each.kind == damage.damages[0].kind && each.centroid_px[0] > box[0] && each.centroid_px[0] < box[2];
    });
    ASSERT_NE(cut, found.end()) << grey;
    EXPECT_TRUE(cut->cut_by_border);
    EXPECT_NEAR(cut->metrics->max_depth_m.value, damage.damages[0].metrics->max_depth_m.value, 0.01);
  }
}

TEST(Pipeline, WarmUpChecksSizeFirst) {
  Pipeline pipeline(preset("default"));
  for (const auto& [width, height] : {std::pair{-1, 3}, {1'000'000, 1'000'000}, {31, 64}}) {
    try {
      pipeline.warm_up(width, height);
      FAIL() << width;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(std::to_string(width)), std::string::npos) << error.what();
    }
  }
}

/// Stripes along the rows tell nothing of the rows.
TEST(Pipeline, SaysThatRowsAreUnknown) {
  std::vector<std::uint8_t> stripes(std::size_t{320} * 240);
  for (std::size_t k = 0; k < stripes.size(); ++k) stripes[k] = static_cast<std::uint8_t>(120 + (k % 320 * 37) % 90);
  const FrameView picture = FrameView::grey8(stripes.data() + 4, 300, 240, 320);
  const FrameView moved = FrameView::grey8(stripes.data(), 300, 240, 320);
  Pipeline pipeline(preset("default"));
  const FrameResult& result = pipeline.process(moved, picture);
  EXPECT_FALSE(result.rows.known());
  const bool is_said = std::any_of(result.warnings.begin(), result.warnings.end(),
                                   [](const std::string& warning) { return warning_code(warning) == "rows-unknown"; });
  EXPECT_TRUE(is_said);
}

/// Bars beside the picture match where they stand, at a disparity of 0: that is no evidence against the road.
TEST(Pipeline, FindsRoadBetweenBlackBars) {
  synth::SyntheticPair pair = scene("street");
  const int width = pair.left.width, height = pair.left.height;
  const std::size_t channels = pair.left.bytes.size() / static_cast<std::size_t>(width * height);
  for (Frame* const view : {&pair.left, &pair.right}) {
    for (int v = 0; v < height; ++v) {
      const auto row = view->bytes.begin() + static_cast<std::ptrdiff_t>(v * width) * std::ptrdiff_t(channels);
      const auto bar = static_cast<std::ptrdiff_t>(width / 5) * std::ptrdiff_t(channels);
      std::fill(row, row + bar, std::uint8_t{0});
      std::fill(row + std::ptrdiff_t(channels) * width - bar, row + std::ptrdiff_t(channels) * width, std::uint8_t{0});
    }
  }
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 0; v < height; ++v) {
    std::fill_n(mask.row(v), width / 5, std::uint8_t{255});
    std::fill_n(mask.row(v) + width - width / 5, width / 5, std::uint8_t{255});
  }
  Pipeline pipeline(options, pair.calibration), masked(options, pair.calibration);
  masked.set_mask(mask);
  const RoadModelEstimate& road = pipeline.process(pair.left.view(), pair.right.view()).road;
  ASSERT_EQ(road.status, RoadStatus::found) << road.reason;
  EXPECT_NEAR(road.evidence, masked.process(pair.left.view(), pair.right.view()).road.evidence, 0.01);
  for (const int v : {height - 1, 2 * height / 3}) {
    EXPECT_NEAR(road.model.disparity(width / 2, v), pair.plane.disparity(width / 2, v), 0.5);
  }
}

TEST(PipelineMask, OfAnotherSizeIsRejected) {
  const synth::SyntheticPair pair = scene("demo");
  PipelineOptions options = preset("fast");
  options.engine = "cpu";
  Pipeline pipeline(options);
  pipeline.set_mask(lower_third(300, 200));
  try {
    pipeline.process(pair.left.view(), pair.right.view());
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the mask has 300×200 pixels; it must have 960×540 like the pair");
  }
}

TEST(PipelinePrior, WarnsWhereRoadDisagrees) {
  const synth::SyntheticPair pair = scene("uav");
  const auto warnings = [&](double height_m) {
    PipelineOptions options = preset("fast");
    options.road_model.height_m = height_m;
    Pipeline pipeline(options, pair.calibration);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status, RoadStatus::found);
    return result.warnings;
  };
  const double height_m = synth::named_scene("uav").rig.camera_height_m;
  EXPECT_TRUE(warnings(1.1 * height_m).empty());
  const auto told = warnings(1.5 * height_m);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told.front().find("m above the road that was found"), std::string::npos) << told.front();
}

struct SceneFigures {
  const char* scene;
  Errors errors;
};

class PipelineScene : public testing::TestWithParam<SceneFigures> {};

TEST_P(PipelineScene, ErrorIsAsMeasured) {
  const synth::SyntheticPair pair = scene(GetParam().scene);
  Pipeline pipeline(preset("default"), pair.calibration);
  expect_measured(compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair), GetParam().errors);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, PipelineScene,
    testing::Values(SceneFigures{"demo", {0.00611, 0, 0}}, SceneFigures{"uav", {0.00585, 0, 0}},
                    SceneFigures{"street", {0.00505, 0.000735, 0.00265}}, SceneFigures{"nadir", {0.0107, 0, 0}},
                    SceneFigures{"close", {0.00517, 0.000226, 0.000328}}, SceneFigures{"low_texture", {0.00835, 0, 0}},
                    SceneFigures{"noise", {0.0137, 0, 0}}, SceneFigures{"blur", {0.00846, 0, 0}},
                    SceneFigures{"overexposed", {0.00793, 0, 0}}, SceneFigures{"rolled", {0.00621, 0, 0}}),
    [](const auto& test) { return std::string(test.param.scene); });

TEST(Pipeline, RecoversRoll) {
  const synth::SyntheticPair pair = scene("rolled");
  Pipeline pipeline(preset("default"), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_TRUE(result.geometry.roll_observable);
  EXPECT_NEAR(result.geometry.roll_rad, pair.roll_rad, 0.002);
}

TEST(Pipeline, RollIsNotObservableAtNadir) {
  const synth::SyntheticPair pair = scene("nadir");
  Pipeline pipeline(preset("default"), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_TRUE(result.roll_found);
  EXPECT_FALSE(result.geometry.roll_observable);
  EXPECT_LT(result.spread.sigma_road_px, 0.5);
}

TEST(Pipeline, WorksWithoutCalibration) {
  const synth::SyntheticPair pair = scene("uav");
  Pipeline pipeline(preset("default"));
  expect_measured(compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair), {0.0058, 0, 0});
}

TEST(Pipeline, CarriesRoadModelOver) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  Pipeline pipeline;
  for (int frame = 0; frame < 3; ++frame) {
    const synth::SyntheticPair pair = synth::render(synth::next_frame(s, frame));
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status == RoadStatus::tracked, frame > 0);
    EXPECT_NEAR(result.geometry.plane.disparity(320, 300), pair.plane.disparity(320, 300), 0.3);
  }
  pipeline.reset();
  const synth::SyntheticPair pair = synth::render(s);
  EXPECT_NE(pipeline.process(pair.left.view(), pair.right.view()).road.status, RoadStatus::tracked);
}

bool same_bits(const Image<float>& one, const Image<float>& other) {
  return one.pixels() == other.pixels() && std::memcmp(one.row(0), other.row(0), one.pixels() * sizeof(float)) == 0;
}

TEST(Pipeline, CarriedStateResumesIdentically) {
  synth::Scene first = synth::named_scene("uav");
  first.supersampling = 1;
  const synth::SyntheticPair one = synth::render(first);
  const synth::SyntheticPair two = synth::render(synth::next_frame(first, 1));
  Pipeline whole(preset("default"), one.calibration);
  whole.process(one.left.view(), one.right.view());
  Pipeline resumed(preset("default"), one.calibration);
  resumed.restore(whole.carried());
  const FrameResult& expected = whole.process(two.left.view(), two.right.view());
  const FrameResult& result = resumed.process(two.left.view(), two.right.view());
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(same_bits(result.disparity, expected.disparity));
  EXPECT_TRUE(same_bits(result.transformed, expected.transformed));
  EXPECT_EQ(result.geometry.roll_rad, expected.geometry.roll_rad);
}

TEST(Pipeline, CallerOwnedResultOutlivesNextFrame) {
  synth::Scene first = synth::named_scene("uav");
  first.supersampling = 1;
  const synth::SyntheticPair one = synth::render(first);
  const synth::SyntheticPair two = synth::render(synth::next_frame(first, 1));
  Pipeline keeping(preset("fast"), one.calibration);
  Pipeline handing(preset("fast"), one.calibration);
  std::array<FrameResult, 2> handed;
  handing.process(one.left.view(), one.right.view(), handed[0]);
  handing.process(two.left.view(), two.right.view(), handed[1]);
  EXPECT_TRUE(same_bits(handed[0].disparity, keeping.process(one.left.view(), one.right.view()).disparity));
  const DamageMap expected = [&] {
    keeping.process(two.left.view(), two.right.view());
    return keeping.find_damage();
  }();
  const DamageMap damage = find_damage(handed[1], two.calibration);
  ASSERT_EQ(damage.damages.size(), expected.damages.size());
  EXPECT_EQ(damage.ids, expected.ids);
  EXPECT_THROW(handing.find_damage(), Error);
}

TEST(Pipeline, JumpIsDetectedInSameFrame) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  Pipeline pipeline;
  const synth::SyntheticPair before = synth::render(s);
  pipeline.process(before.left.view(), before.right.view());
  s.rig.camera_height_m *= 0.6;
  const synth::SyntheticPair after = synth::render(s);
  const FrameResult& result = pipeline.process(after.left.view(), after.right.view());
  EXPECT_NEAR(result.geometry.plane.disparity(320, 300), after.plane.disparity(320, 300), 0.3);
  EXPECT_LT(compare(result.disparity, after).missing, 0.1);
}

TEST(Pipeline, WarnsAboutRowOffset) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_offset_px = 1.5;
  const synth::SyntheticPair pair = synth::render(s);
  Pipeline pipeline;
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_NEAR(result.rows.median_px, 1.5, 0.15);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.back().find("the rows of the pair are not aligned"), std::string::npos);
  EXPECT_EQ(warning_code(result.warnings.back()), "rows-disagree");
  EXPECT_EQ(warning_code("A sentence: with a colon"), "");
  EXPECT_EQ(warning_code("word"), "");
}

/// The default preset with rows corrected or not.
FrameResult process_rows(const synth::SyntheticPair& pair, bool correct) {
  PipelineOptions options = preset("default");
  options.correct_rows = correct;
  Pipeline pipeline(options, pair.calibration);
  FrameResult result;
  pipeline.process(pair.left.view(), pair.right.view(), result);
  return result;
}

TEST(Pipeline, RowCorrectionHalvesError) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_offset_px = 0.8;
  const synth::SyntheticPair pair = synth::render(s);
  const FrameResult corrected = process_rows(pair, true), raw = process_rows(pair, false);
  EXPECT_NEAR(corrected.shift.misalignment.rows_px, 0.8, 0.1);
  EXPECT_EQ(raw.shift.misalignment.rows_px, 0);
  EXPECT_LT(compare(corrected.disparity, pair).median, 0.5 * compare(raw.disparity, pair).median);
}

// Turned by 0.05° the rows are 0.28 px apart at either side of 640 columns, and disparities are 0.16 px off at the
// lower border of 360 rows.
TEST(Pipeline, TurnOfRightCameraIsUndone) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_rotation_deg = 0.05;
  const synth::SyntheticPair pair = synth::render(s);
  const FrameResult corrected = process_rows(pair, true), raw = process_rows(pair, false);
  EXPECT_NEAR(std::abs(corrected.shift.misalignment.turn_rad), 0.05 * std::numbers::pi / 180, 1e-4);
  EXPECT_NEAR(corrected.shift.misalignment.rows_px, 0, 0.05);
  EXPECT_LT(compare(corrected.disparity, pair).median, 0.3 * compare(raw.disparity, pair).median);
}

// The texture of a street runs towards the horizon, on either side another way: matched in wrong rows, the road rolls.
TEST(Pipeline, RoadModelIsThatOfAlignedRows) {
  synth::Scene s = synth::named_scene("street");
  s.degradation.row_offset_px = -0.6;
  const synth::SyntheticPair pair = synth::render(s);
  const auto error = [&](bool correct) {
    return std::abs(process_rows(pair, correct).road.model.disparity(320, 250) - pair.plane.disparity(320, 250));
  };
  EXPECT_LT(error(true), 0.5 * error(false));
}

struct SigmaFigures {
  const char* scene;
  double above_two;  ///< share of the errors above 2σ: 0.046 of normal ones
  double typical;    ///< median error in σ, as a multiple of that of normal errors
};

class PipelineSigma : public testing::TestWithParam<SigmaFigures> {};

TEST_P(PipelineSigma, CoversErrors) {
  const synth::SyntheticPair pair = scene(GetParam().scene);
  Pipeline pipeline(preset("default"), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  std::vector<double> in_sigmas;
  for (int v = 0; v < pair.left.height; ++v) {
    for (int u = 0; u < pair.left.width; ++u) {
      const float disparity = result.disparity(u, v), sigma = result.sigma(u, v);
      ASSERT_EQ(std::isnan(disparity), std::isnan(sigma)) << u << ", " << v;
      if (std::isnan(disparity)) continue;
      ASSERT_GT(sigma, 0) << u << ", " << v;
      if (pair.visible(u, v) == 0 || std::isnan(pair.disparity(u, v))) continue;
      in_sigmas.push_back(std::abs(disparity - pair.disparity(u, v)) / double{sigma});
    }
  }
  std::sort(in_sigmas.begin(), in_sigmas.end());
  const auto count = static_cast<double>(in_sigmas.size());
  const auto below_two = std::lower_bound(in_sigmas.begin(), in_sigmas.end(), 2.0) - in_sigmas.begin();
  constexpr double median_of_normal = 0.6745;
  const double scale = in_sigmas[in_sigmas.size() / 2] / median_of_normal;
  const double above_two = 1 - static_cast<double>(below_two) / count;
  RecordProperty("share_above_2_sigma", std::to_string(above_two));
  RecordProperty("typical_error_in_sigmas", std::to_string(scale));
  EXPECT_LE(above_two, slack * GetParam().above_two);
  EXPECT_LE(scale, slack * GetParam().typical);
  EXPECT_GE(slack * scale, GetParam().typical);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PipelineSigma,
                         testing::Values(SigmaFigures{"uav", 0.00994, 0.589}, SigmaFigures{"noise", 0.0612, 0.962}),
                         [](const auto& test) { return std::string(test.param.scene); });

TEST(Pipeline, ColourAndSixteenBitsGiveSameMap) {
  const synth::SyntheticPair pair = scene("uav");
  const auto widen = [](const Frame& grey) {
    Frame wide{{}, grey.width, grey.height, SampleType::u16, ChannelOrder::bgr};
    for (const std::uint8_t value : grey.bytes) {
      for (int c = 0; c < 3; ++c) {
        wide.bytes.push_back(value);  // value · 257, either byte order
        wide.bytes.push_back(value);
      }
    }
    return wide;
  };
  Pipeline a, b;
  const FrameResult& grey = a.process(pair.left.view(), pair.right.view());
  const Frame left = widen(pair.left), right = widen(pair.right);
  const FrameResult& colour = b.process(left.view(), right.view());
  for (int v = 0; v < pair.left.height; v += 7) {
    for (int u = 0; u < pair.left.width; u += 5) {
      const float x = grey.disparity(u, v), y = colour.disparity(u, v);
      ASSERT_TRUE(x == y || (std::isnan(x) && std::isnan(y)));
    }
  }
}

TEST(Pipeline, IsIndependentOfThreads) {
  const synth::SyntheticPair pair = scene("uav");
  PipelineOptions one = preset("default"), two = preset("default");
  one.threads = 1;
  two.threads = 2;
  Pipeline a(one), b(two);
  const FrameResult& x = a.process(pair.left.view(), pair.right.view());
  const FrameResult& y = b.process(pair.left.view(), pair.right.view());
  EXPECT_EQ(x.geometry.roll_rad, y.geometry.roll_rad);
  for (int v = 0; v < pair.left.height; ++v) {
    for (int u = 0; u < pair.left.width; ++u) {
      const float p = x.transformed(u, v), q = y.transformed(u, v);
      ASSERT_TRUE(p == q || (std::isnan(p) && std::isnan(q)));
    }
  }
}

std::string refusal(const FrameView& left, const FrameView& right,
                    const std::optional<StereoCalibration>& calibration = std::nullopt) {
  try {
    Pipeline(preset("default"), calibration).process(left, right);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Pipeline, RejectsImagesThatAreNoPair) {
  const synth::SyntheticPair pair = scene("uav");
  Frame black = pair.left;
  std::fill(black.bytes.begin(), black.bytes.end(), std::uint8_t{0});
  EXPECT_EQ(refusal(pair.left.view(), pair.left.view()), "left and right are the same image");
  EXPECT_EQ(refusal(black.view(), pair.right.view()),
            "the left image shows nothing: every pixel has the grey level 0 of 255");
  EXPECT_NE(refusal(pair.right.view(), pair.left.view()).find("left and right look swapped"), std::string::npos);
  FrameView cut = pair.right.view();
  cut.height -= 1;
  EXPECT_NE(refusal(pair.left.view(), cut).find("must have one size"), std::string::npos);
  StereoCalibration wrong = pair.calibration;
  wrong.width = 320;
  EXPECT_NE(refusal(pair.left.view(), pair.right.view(), wrong).find("320"), std::string::npos);
  PipelineOptions options;
  options.matcher.block_radius = 99;
  EXPECT_THROW(Pipeline{options}, Error);
  options = {};
  options.engine = "quantum";
  EXPECT_THROW(Pipeline{options}, Error);
}

}  // namespace
}  // namespace roadstereo
