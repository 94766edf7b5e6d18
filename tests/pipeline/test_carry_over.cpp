// What a pipeline carries over from frame to frame, against the exact truth and against single frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "roadstereo/warning.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr int width = 208;
constexpr int height = 117;

synth::Scene small_road() {
  synth::Scene scene = synth::named_scene("flat");
  scene.supersampling = 1;
  scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
  return scene;
}

/// Largest difference of two planes over the image: in one of its corners.
double difference(const DisparityPlane& a, const DisparityPlane& b, const synth::SyntheticPair& pair) {
  double largest = 0;
  for (const double v : {0.0, pair.left.height - 1.0}) {
    for (const double u : {0.0, pair.left.width - 1.0}) {
      const double one = std::abs(a.disparity(u, v) - b.disparity(u, v));
      if (std::isnan(one) || one > largest) largest = one;
    }
  }
  return largest;
}

struct Errors {
  std::vector<double> roll, before, after;  ///< ψ and the plane before and after matching

  void add(const FrameResult& result, const synth::SyntheticPair& pair) {
    ASSERT_TRUE(result.road.has_road());
    ASSERT_TRUE(result.roll_found);
    roll.push_back(std::abs(result.geometry.roll_rad - pair.roll_rad));
    before.push_back(difference(result.road.model, pair.plane, pair));
    after.push_back(difference(result.geometry.plane, pair.plane, pair));
  }
};

double largest(const std::vector<double>& values) {
  EXPECT_TRUE(std::none_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }));
  return *std::max_element(values.begin(), values.end());
}

TEST(CarryOver, IsAsGoodAsSingleFrames) {
  const synth::Scene scene = small_road();
  synth::FlightPath path;
  path.roll_period = path.pitch_period = path.climb_period = 40;
  Pipeline carried, fresh;
  Errors of_carried, of_fresh;
  for (int frame = 0; frame < 40; ++frame) {
    SCOPED_TRACE(frame);
    const synth::SyntheticPair pair = synth::render(synth::flight_frame(scene, path, frame));
    const FrameResult& result = carried.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status == RoadStatus::tracked, frame > 0);
    of_carried.add(result, pair);
    fresh.reset();
    of_fresh.add(fresh.process(pair.left.view(), pair.right.view()), pair);
  }
  RecordProperty("roll_carried_rad", std::to_string(largest(of_carried.roll)));
  RecordProperty("roll_fresh_rad", std::to_string(largest(of_fresh.roll)));
  RecordProperty("model_carried_px", std::to_string(largest(of_carried.before)));
  RecordProperty("model_fresh_px", std::to_string(largest(of_fresh.before)));
  RecordProperty("plane_carried_px", std::to_string(largest(of_carried.after)));
  RecordProperty("plane_fresh_px", std::to_string(largest(of_fresh.after)));
  // The same but for noise: both are measured on the same frame, a little differently.
  EXPECT_LE(largest(of_carried.roll), 1.7 * largest(of_fresh.roll));
  EXPECT_LE(largest(of_carried.before), 1.5 * largest(of_fresh.before));
  EXPECT_LE(largest(of_carried.after), 1.5 * largest(of_fresh.after));
}

struct Jump {
  const char* name;
  void (*change)(synth::Scene&);
};

class CarryOverJump : public testing::TestWithParam<Jump> {};

TEST_P(CarryOverJump, IsDetectedInSameFrame) {
  synth::Scene scene = small_road();
  const synth::SyntheticPair before = synth::render(scene);
  GetParam().change(scene);
  const synth::SyntheticPair after = synth::render(scene);
  Pipeline carried, fresh;
  carried.process(before.left.view(), before.right.view());
  const FrameResult& result = carried.process(after.left.view(), after.right.view());
  EXPECT_NE(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(result.road.has_road());
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.front().find("searched again"), std::string::npos);
  // Of the frame before only the order of the planes is left, and so the place where a search starts.
  const FrameResult& expected = fresh.process(after.left.view(), after.right.view());
  EXPECT_LT(difference(result.road.model, expected.road.model, after), 0.03);
  EXPECT_LT(difference(result.geometry.plane, expected.geometry.plane, after), 0.003);
  EXPECT_NEAR(result.geometry.roll_rad, expected.geometry.roll_rad, 0.001);
  EXPECT_LT(difference(result.geometry.plane, after.plane, after), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CarryOverJump,
                         testing::Values(Jump{"Drop", [](synth::Scene& s) { s.rig.camera_height_m *= 0.5; }},
                                         Jump{"Cut",
                                              [](synth::Scene& s) {
                                                s.road.seed = 77;
                                                s.road.lane_marking = true;
                                                s.rig.pitch_deg = 80;
                                                s.rig.roll_deg = -12;
                                                s.rig.camera_height_m = 1.7;
                                              }}),
                         [](const auto& test) { return std::string(test.param.name); });

class CarryOverMove : public testing::TestWithParam<Jump> {};

TEST_P(CarryOverMove, IsTracked) {
  synth::Scene scene = small_road();
  const synth::SyntheticPair before = synth::render(scene);
  GetParam().change(scene);
  const synth::SyntheticPair after = synth::render(scene);
  Pipeline carried;
  carried.process(before.left.view(), before.right.view());
  const FrameResult& result = carried.process(after.left.view(), after.right.view());
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_LT(difference(result.road.model, after.plane, after), 0.15);
  EXPECT_LT(difference(result.geometry.plane, after.plane, after), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CarryOverMove,
                         testing::Values(Jump{"Bump",
                                              [](synth::Scene& s) {
                                                s.rig.pitch_deg += 4;
                                                s.rig.camera_height_m -= 0.2;
                                              }},
                                         Jump{"Turn", [](synth::Scene& s) { s.rig.roll_deg += 10; }}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(CarryOver, UnexpectedPoseIsToldOfEveryFrame) {
  const synth::SyntheticPair pair = synth::render(small_road());
  PipelineOptions options = preset("default");
  const auto codes = [&](double height_share) {
    options.road_model.height_m = height_share * small_road().rig.camera_height_m;
    Pipeline pipeline(options, pair.calibration);
    pipeline.process(pair.left.view(), pair.right.view());
    std::vector<std::string> found;
    for (const std::string& warning : pipeline.process(pair.left.view(), pair.right.view()).warnings) {
      found.emplace_back(warning_code(warning));
    }
    return found;
  };
  EXPECT_EQ(codes(1.1), std::vector<std::string>{});
  EXPECT_EQ(codes(2), (std::vector<std::string>{"road-anew", "unexpected-pose"}));
}

TEST(CarryOver, CutToSimilarRoadIsAsGoodAsSingleFrame) {
  synth::Scene scene = small_road();
  const synth::SyntheticPair before = synth::render(scene);
  scene.road.seed = 5;
  scene.rig.y_m = 50;
  scene.rig.camera_height_m *= 1.02;
  const synth::SyntheticPair after = synth::render(scene);
  Pipeline carried, fresh;
  carried.process(before.left.view(), before.right.view());
  const FrameResult& result = carried.process(after.left.view(), after.right.view());
  const FrameResult& expected = fresh.process(after.left.view(), after.right.view());
  EXPECT_LT(difference(result.road.model, after.plane, after), 0.1);
  EXPECT_LE(difference(result.geometry.plane, after.plane, after),
            difference(expected.geometry.plane, after.plane, after) + 0.01);
}

TEST(WarmUp, LeavesResultsUnchanged) {
  const synth::SyntheticPair pair = synth::render(small_road());
  Pipeline warm(preset("default"), pair.calibration), cold(preset("default"), pair.calibration);
  warm.warm_up(width, height);
  EXPECT_THROW(warm.find_damage(), Error);
  EXPECT_THROW(warm.warm_up(width + 1, height), Error);  // the calibration is of another size
  const FrameResult& result = warm.process(pair.left.view(), pair.right.view());
  const FrameResult& expected = cold.process(pair.left.view(), pair.right.view());
  EXPECT_NE(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_EQ(difference(result.geometry.plane, expected.geometry.plane, pair), 0);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const float a = result.disparity(u, v), b = expected.disparity(u, v);
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(WarmUp, AcceptsEveryWhiteLevelAndSize) {
  for (const double white_level : {0.0, 200.0, 4095.0}) {
    PipelineOptions options;
    options.white_level = white_level;
    Pipeline pipeline(options);
    EXPECT_NO_THROW(pipeline.warm_up(32, 32));
    EXPECT_NO_THROW(pipeline.warm_up(320, 48));
  }
}

TEST(CarryOver, RestartsAfterFrameWithoutRoad) {
  const synth::SyntheticPair road = synth::render(small_road());
  const auto picture = [](std::uint32_t seed) {
    const auto pair = test::textured_pair(
        width, height, [](double, double) { return 0; }, seed);
    Frame frame{{}, width, height, SampleType::u8, ChannelOrder::grey};
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        frame.bytes.push_back(static_cast<std::uint8_t>(pair.reference(u, v) / grey_scale));
      }
    }
    return frame;
  };
  const Frame left = picture(1), right = picture(99);  // two pictures that have nothing to do with each other
  Pipeline carried, fresh;
  carried.process(road.left.view(), road.right.view());
  EXPECT_FALSE(carried.process(left.view(), right.view()).road.has_road());
  const FrameResult& result = carried.process(road.left.view(), road.right.view());
  EXPECT_NE(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(result.road.has_road());
  const FrameResult& expected = fresh.process(road.left.view(), road.right.view());
  EXPECT_EQ(difference(result.geometry.plane, expected.geometry.plane, road), 0);
}

TEST(CarryOver, FramesOfAnotherSizeResetTheState) {
  const synth::SyntheticPair pair = synth::render(small_road());
  PipelineOptions options;
  options.check_rows = false;
  Pipeline pipeline(options);
  PipelineState of_another_size;
  of_another_size.width = 2 * width;
  of_another_size.height = 2 * height;
  of_another_size.misalignment.rows_px = 1;
  pipeline.restore(of_another_size);
  EXPECT_EQ(pipeline.process(pair.left.view(), pair.right.view()).shift.misalignment.rows_px, 0);
  EXPECT_EQ(pipeline.carried().misalignment.rows_px, 0);
}

/// The small road with noise of so many grey levels and rows that are so far apart.
synth::SyntheticPair degraded_road(double noise_grey, double row_offset_px) {
  synth::Scene scene = small_road();
  scene.degradation.noise_grey = noise_grey;
  scene.degradation.row_offset_px = row_offset_px;
  return synth::render(scene);
}

void expect_same_state(const PipelineState& one, const PipelineState& other) {
  EXPECT_EQ(one.width, other.width);
  EXPECT_EQ(one.height, other.height);
  EXPECT_EQ(one.roll_rad, other.roll_rad);
  EXPECT_EQ(one.misalignment.rows_px, other.misalignment.rows_px);
  EXPECT_EQ(one.misalignment.turn_rad, other.misalignment.turn_rad);
  EXPECT_EQ(one.misalignment.row_scale, other.misalignment.row_scale);
  EXPECT_EQ(one.misalignment.cx_px, other.misalignment.cx_px);
  EXPECT_EQ(one.misalignment.cy_px, other.misalignment.cy_px);
  EXPECT_EQ(one.rows_known, other.rows_known);
  EXPECT_EQ(one.frames_since_rows, other.frames_since_rows);
  EXPECT_EQ(one.blur_px2, other.blur_px2);
  EXPECT_EQ(one.frames_since_blur, other.frames_since_blur);
  ASSERT_EQ(one.road.has_value(), other.road.has_value());
  if (!one.road) return;
  EXPECT_EQ(one.road->model.a0, other.road->model.a0);
  EXPECT_EQ(one.road->model.a1, other.road->model.a1);
  EXPECT_EQ(one.road->model.a2, other.road->model.a2);
  EXPECT_EQ(one.road->inlier_share, other.road->inlier_share);
  EXPECT_EQ(one.road->correlation, other.road->correlation);
  EXPECT_EQ(one.road->samples_are_cells, other.road->samples_are_cells);
}

/// The small road, or one of another size, seen by a rolled rig whose rows are apart.
synth::SyntheticPair rolled_road(int image_width) {
  synth::Scene scene = small_road();
  scene.rig.focal_px *= static_cast<double>(image_width) / width;
  scene.rig.height = height * image_width / width;
  scene.rig.width = image_width;
  scene.rig.roll_deg = 2;
  scene.degradation.row_offset_px = 0.5;
  return synth::render(scene);
}

/// The rows of a swapped pair are measured before it is known to be one.
TEST(CarryOver, RefusedFrameLeavesTheState) {
  const synth::SyntheticPair pair = rolled_road(width);
  Pipeline pipeline(preset("default"), pair.calibration);
  for (int frame = 0; frame < 3; ++frame) pipeline.process(pair.left.view(), pair.right.view());
  const PipelineState before = pipeline.carried();
  ASSERT_TRUE(before.road.has_value());
  ASSERT_TRUE(before.rows_known);
  ASSERT_NE(before.misalignment.rows_px, 0);
  ASSERT_NE(before.roll_rad, 0);
  EXPECT_THROW(pipeline.process(pair.right.view(), pair.left.view()), Error);
  expect_same_state(pipeline.carried(), before);
  EXPECT_THROW(pipeline.process(pair.left.view(), pair.left.view()), Error);
  expect_same_state(pipeline.carried(), before);
}

/// A narrow frame has fewer disparities than the road is moved by, which is known once its road is: the state of the
/// wide frames is still there.
TEST(CarryOver, FrameRefusedForItsSizeLeavesTheState) {
  const synth::SyntheticPair narrow = rolled_road(width), wide = rolled_road(2 * width);
  PipelineOptions options = preset("default");
  options.perspective.delta_p_px = width;
  Pipeline pipeline(options);
  pipeline.process(wide.left.view(), wide.right.view());
  const PipelineState before = pipeline.carried();
  ASSERT_TRUE(before.road.has_value());
  ASSERT_EQ(before.width, 2 * width);
  EXPECT_THROW(pipeline.process(narrow.left.view(), narrow.right.view()), Error);
  expect_same_state(pipeline.carried(), before);
}

// Supports are chosen by the noise: it may come in the middle of a recording, and go.
TEST(CarryOver, NoiseIsThatOfTheFrame) {
  const synth::SyntheticPair clean = degraded_road(0, 0), noisy = degraded_road(20, 0);
  Pipeline pipeline;
  const double first = pipeline.process(clean.left.view(), clean.right.view()).road.correlation;
  EXPECT_GT(first, 0.9);
  const FrameResult& result = pipeline.process(noisy.left.view(), noisy.right.view());
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_LT(result.road.correlation, 0.6);
  const double last = pipeline.process(clean.left.view(), clean.right.view()).road.correlation;
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_NEAR(last, first, 0.02);
}

TEST(CarryOverRows, StayWhereFrameDoesNotTellThem) {
  const synth::SyntheticPair clean = degraded_road(0, 1.5), noisy = degraded_road(40, 1.5);
  Pipeline pipeline;
  pipeline.process(clean.left.view(), clean.right.view());
  ASSERT_NEAR(pipeline.carried().misalignment.rows_px, 1.5, 0.1);
  PipelineState without_road = pipeline.carried();
  without_road.road.reset();
  pipeline.restore(without_road);
  const FrameResult& result = pipeline.process(noisy.left.view(), noisy.right.view());
  EXPECT_FALSE(result.rows.known());
  EXPECT_NEAR(result.shift.misalignment.rows_px, 1.5, 0.1);
}

TEST(CarryOverRows, AreToldOnceOfFrameThatLosesItsRoad) {
  const synth::SyntheticPair pair = degraded_road(0, 1.5);
  Pipeline pipeline;
  pipeline.process(pair.left.view(), pair.right.view());
  PipelineState lost = pipeline.carried();
  lost.road->model.a0 += 20;
  lost.frames_since_rows = 1000;
  pipeline.restore(lost);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  ASSERT_EQ(result.road.status, RoadStatus::found);
  EXPECT_EQ(std::count_if(result.warnings.begin(), result.warnings.end(),
                          [](const std::string& text) { return warning_code(text) == "rows-disagree"; }),
            1);
}

TEST(CarryOverRows, AreMeasuredOnTrackedRoadUntilKnown) {
  const synth::SyntheticPair pair = degraded_road(0, 1.5);
  Pipeline pipeline;
  pipeline.process(pair.left.view(), pair.right.view());
  PipelineState unknown = pipeline.carried();
  unknown.rows_known = false;
  unknown.misalignment = {};
  pipeline.restore(unknown);
  const auto process = [&]() -> const FrameResult& { return pipeline.process(pair.left.view(), pair.right.view()); };
  for (int frame = 1; frame < 10; ++frame) EXPECT_FALSE(process().rows.known());
  const FrameResult& result = process();
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_TRUE(pipeline.carried().rows_known);
  EXPECT_NEAR(result.shift.misalignment.rows_px, 1.5, 0.1);
}

// A mount that creeps by a pixel; one that stands still keeps its bits.
TEST(CarryOverRows, FollowCreepingMount) {
  const synth::SyntheticPair before = degraded_road(0, 0.4), after = degraded_road(0, 1.4);
  Pipeline pipeline;
  pipeline.process(before.left.view(), before.right.view());
  const auto process_when_due = [&](const synth::SyntheticPair& pair) {
    PipelineState state = pipeline.carried();
    state.frames_since_rows = 100;
    pipeline.restore(state);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status, RoadStatus::tracked);
    EXPECT_TRUE(result.rows.known());
    return result.shift.misalignment.rows_px;
  };
  const double first = pipeline.carried().misalignment.rows_px;
  EXPECT_NEAR(first, 0.4, 0.1);
  const synth::SyntheticPair little_noise = degraded_road(1, 0.4);
  EXPECT_EQ(process_when_due(little_noise), first);
  EXPECT_NEAR(process_when_due(after), 1.4, 0.1);
}

// What a damaged journal may hold: none of it reaches the images.
TEST(CarryOver, StateThatNoFrameLeavesIsRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Pipeline pipeline;
  PipelineState state;
  state.width = width;
  state.height = height;
  state.road = TrackedRoad{{1, 0.1, 0}, 0.5, 0.5};
  EXPECT_NO_THROW(pipeline.restore(state));
  for (const double a0 : {1e300, -1e300, 1e4, nan}) {
    PipelineState hostile = state;
    hostile.road->model.a0 = a0;
    EXPECT_THROW(pipeline.restore(hostile), Error) << a0;
  }
  for (const double rows_px : {8.5, -8.5, 1e300, nan}) {
    PipelineState hostile = state;
    hostile.misalignment.rows_px = rows_px;
    EXPECT_THROW(pipeline.restore(hostile), Error) << rows_px;
  }
  PipelineState before_first = state;
  before_first.frames_since_rows = -1;
  EXPECT_THROW(pipeline.restore(before_first), Error);
  for (const double turn : {0.5, nan}) {
    PipelineState hostile = state;
    hostile.misalignment.turn_rad = turn;
    EXPECT_THROW(pipeline.restore(hostile), Error) << turn;
  }
}

}  // namespace
}  // namespace roadstereo
