// The whole way through on synthetic roads with exact truth, for every preset.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/deblocking.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "tests/pipeline/synthetic_truth.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// How much worse than measured a figure may become, and a share of pixels that rounding alone may change.
constexpr double slack = 1.25;
constexpr double rounded = 1e-4;

void expect_measured(const test::Errors& errors, const test::Errors& measured) {
  testing::Test::RecordProperty("median_px", std::to_string(errors.median));
  testing::Test::RecordProperty("share_above_1px", std::to_string(errors.share_above_1px));
  testing::Test::RecordProperty("missing", std::to_string(errors.missing));
  EXPECT_LE(errors.median, slack * measured.median);
  EXPECT_LE(errors.share_above_1px, std::max(rounded, slack * measured.share_above_1px));
  EXPECT_LE(errors.missing, std::max(rounded, slack * measured.missing));
}

struct PresetFigures {
  const char* preset;
  test::Errors errors;
  double roll_rad, sigma_road_px;  ///< error of ψ, spread of the transformed road
  double depth_px;                 ///< error of the mean depth of the demo's potholes
};

class PipelinePreset : public testing::TestWithParam<PresetFigures> {};

TEST_P(PipelinePreset, MatchesRoadFromAir) {
  const synth::SyntheticPair pair = test::named_pair("uav");
  Pipeline pipeline(preset(GetParam().preset), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  expect_measured(test::compare(result.disparity, pair), GetParam().errors);
  EXPECT_TRUE(result.road.has_road());
  const double roll_error = std::abs(result.geometry.roll_rad - pair.roll_rad);
  RecordProperty("roll_rad", std::to_string(roll_error));
  RecordProperty("road_px", std::to_string(result.spread.sigma_road_px));
  EXPECT_LE(roll_error, slack * GetParam().roll_rad);
  EXPECT_LE(result.spread.sigma_road_px, slack * GetParam().sigma_road_px);
}

TEST_P(PipelinePreset, PotholesLieBelowRoadInTransformedMap) {
  const synth::SyntheticPair pair = test::named_pair("demo");
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

TEST(PipelinePrior, WarnsWhereRoadDisagrees) {
  const synth::SyntheticPair pair = test::named_pair("uav");
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
  test::Errors errors;
};

class PipelineScene : public testing::TestWithParam<SceneFigures> {};

TEST_P(PipelineScene, ErrorIsAsMeasured) {
  const synth::SyntheticPair pair = test::named_pair(GetParam().scene);
  Pipeline pipeline(preset("default"), pair.calibration);
  expect_measured(test::compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair),
                  GetParam().errors);
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
  const synth::SyntheticPair pair = test::named_pair("rolled");
  Pipeline pipeline(preset("default"), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_TRUE(result.geometry.roll_observable);
  EXPECT_NEAR(result.geometry.roll_rad, pair.roll_rad, 0.002);
}

TEST(Pipeline, RollIsNotObservableAtNadir) {
  const synth::SyntheticPair pair = test::named_pair("nadir");
  Pipeline pipeline(preset("default"), pair.calibration);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_TRUE(result.roll_found);
  EXPECT_FALSE(result.geometry.roll_observable);
  EXPECT_LT(result.spread.sigma_road_px, 0.5);
}

TEST(Pipeline, WorksWithoutCalibration) {
  const synth::SyntheticPair pair = test::named_pair("uav");
  Pipeline pipeline(preset("default"));
  expect_measured(test::compare(pipeline.process(pair.left.view(), pair.right.view()).disparity, pair), {0.0058, 0, 0});
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
  EXPECT_LT(test::compare(result.disparity, after).missing, 0.1);
}

struct SigmaFigures {
  const char* scene;
  double above_two;  ///< share of the errors above 2σ: 0.046 of normal ones
  double typical;    ///< median error in σ, as a multiple of that of normal errors
};

class PipelineSigma : public testing::TestWithParam<SigmaFigures> {};

TEST_P(PipelineSigma, CoversErrors) {
  const synth::SyntheticPair pair = test::named_pair(GetParam().scene);
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
  const synth::SyntheticPair pair = test::named_pair("uav");
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

/// Adds up to ±3 to each block of 8×8 pixels, as strong compression does.
void shift_blocks(Frame& frame, std::uint64_t seed) {
  const std::size_t channels = frame.bytes.size() / static_cast<std::size_t>(frame.width * frame.height);
  for (std::size_t k = 0; k < frame.bytes.size(); ++k) {
    const auto pixel = static_cast<std::int64_t>(k / channels);
    const double change = 6 * test::lattice(pixel % frame.width / 8, pixel / frame.width / 8, seed) - 3;
    frame.bytes[k] = static_cast<std::uint8_t>(std::clamp(frame.bytes[k] + std::lround(change), 0L, 255L));
  }
}

TEST(Pipeline, SmoothsStepsBetweenBlocks) {
  const synth::SyntheticPair clean = test::named_pair("low_texture");
  synth::SyntheticPair pair = clean;
  shift_blocks(pair.left, 1);
  shift_blocks(pair.right, 2);
  PipelineOptions options;
  Pipeline smoothing(options, pair.calibration);
  options.deblock = false;
  Pipeline plain(options, pair.calibration);
  const FrameResult& smoothed = smoothing.process(pair.left.view(), pair.right.view());
  const FrameResult& as_it_is = plain.process(pair.left.view(), pair.right.view());
  EXPECT_EQ(smoothed.block_steps, as_it_is.block_steps);
  const std::array<const GreyImage*, 2> images{&as_it_is.grey, &as_it_is.right},
      better{&smoothed.grey, &smoothed.right};
  for (std::size_t k = 0; k < images.size(); ++k) {
    const double before = measure_block_steps(*images[k]).excess();
    EXPECT_GT(before, 0.1);
    EXPECT_EQ(as_it_is.block_steps[k], before);
    EXPECT_LT(measure_block_steps(*better[k]).excess(), 0.75 * before);
  }
  smoothing.reset();
  plain.reset();
  EXPECT_TRUE(same_bits(smoothing.process(clean.left.view(), clean.right.view()).disparity,
                        plain.process(clean.left.view(), clean.right.view()).disparity));
}

TEST(Pipeline, IsIndependentOfThreads) {
  const synth::SyntheticPair pair = test::named_pair("uav");
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
  const synth::SyntheticPair pair = test::named_pair("uav");
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
