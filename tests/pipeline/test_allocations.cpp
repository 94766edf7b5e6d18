// After the first frame nothing is allocated, and matching needs little memory beyond images and maps.

#include <gtest/gtest.h>

#include <cmath>

#include "allocation_count.hpp"
#include "core/scratch.hpp"
#include "roadstereo/lens_spots.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/static_mask.hpp"
#include "roadstereo/synth.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

#define SKIP_WITHOUT_COUNT() \
  if (!allocations()) GTEST_SKIP() << "malloc cannot be counted in this build"

TEST(AllocationCount, CountsNewBlocks) {
  SKIP_WITHOUT_COUNT();
  const Allocations before = *allocations();
  const auto block = std::make_unique<std::vector<char>>(1 << 20);
  EXPECT_GE(allocations()->count, before.count + 2);
  EXPECT_GE(allocations()->live_bytes, before.live_bytes + (1 << 20));
}

TEST(ScratchMemory, KeepsBlocksOfEverySize) {
  SKIP_WITHOUT_COUNT();
  ScratchMemory memory;
  const ScratchScope scope(memory);
  const auto use = [] {
    for (std::size_t bytes = 100; bytes < (20U << 20); bytes = 3 * bytes / 2) {
      const auto one = scratch_vector<char>(bytes), other = scratch_vector<char>(bytes + bytes / 7);
    }
  };
  use();
  const std::size_t before = allocations()->count;
  use();
  EXPECT_EQ(allocations()->count - before, 0U);
}

TEST(ScratchMemory, GoesBackAtTheEnd) {
  SKIP_WITHOUT_COUNT();
  const auto before = allocations()->live_bytes;
  {
    ScratchMemory memory;
    const ScratchScope scope(memory);
    scratch_vector<char>(6U << 20);
    EXPECT_GE(allocations()->live_bytes, before + (6U << 20));
  }
  EXPECT_EQ(allocations()->live_bytes, before);
}

/// TBB keeps its threads. Without it they are started for every loop, which allocates.
#ifdef ROADSTEREO_WITH_TBB
constexpr int max_threads = 2;
#else
constexpr int max_threads = 1;
#endif

TEST(LensWatchAllocations, ForFirstFrameOnly) {
  SKIP_WITHOUT_COUNT();
  GreyImage frame(320, 180);
  LensWatch watch;
  const auto add = [&](int i) {
    for (int v = 0; v < frame.height(); ++v) {
      for (int u = 0; u < frame.width(); ++u)
        frame(u, v) = static_cast<std::int16_t>((i * (7 * u + 13 * v) * v) % grey_max);
    }
    watch.add(frame);
  };
  add(1);
  const std::size_t before = allocations()->count;
  for (int i = 2; i <= 45; ++i) add(i);
  EXPECT_EQ(allocations()->count - before, 0U);
  EXPECT_FALSE(std::isnan(watch.spots().dirt));
}

TEST(StaticMaskAllocations, ForFirstFrameAndWhenItJudgesOnly) {
  SKIP_WITHOUT_COUNT();
  GreyImage frame(320, 180);
  StaticMask mask;
  const auto add = [&](int i) {
    for (int v = 0; v < frame.height(); ++v) {
      for (int u = 0; u < frame.width(); ++u)
        frame(u, v) = static_cast<std::int16_t>((i * (7 * u + 13 * v) * v) % grey_max);
    }
    return mask.add(frame, frame, std::nullopt);
  };
  add(1);
  std::size_t before = allocations()->count;
  for (int i = 2; i <= 19; ++i) add(i);
  EXPECT_EQ(allocations()->count - before, 0U);
  EXPECT_FALSE(add(20));
  before = allocations()->count;
  for (int i = 21; i <= 39; ++i) add(i);
  EXPECT_EQ(allocations()->count - before, 0U);
  ASSERT_TRUE(add(40));
  before = allocations()->count;
  for (int i = 41; i <= 50; ++i) add(i);
  EXPECT_EQ(allocations()->count - before, 0U);
}

/// Presets, and the noise of the pictures: its correlation, which the weight of the prior follows, is never the same.
class PresetAllocations : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  static const std::string& preset_name() { return std::get<0>(GetParam()); }
  static int noise_grey() { return std::get<1>(GetParam()); }
};

TEST_P(PresetAllocations, NoneAfterFirstFrames) {
  SKIP_WITHOUT_COUNT();
  synth::Scene scene = synth::named_scene("uav");
  scene.rig.width = 320;
  scene.rig.height = 240;
  scene.supersampling = 1;
  scene.degradation.noise_grey = noise_grey();
  std::vector<synth::SyntheticPair> frames;
  for (int i = 0; i < 3; ++i) {
    frames.push_back(synth::render(scene));
    scene = synth::next_frame(scene, i + 1, 0.05);
  }
  for (int threads = 1; threads <= max_threads; ++threads) {
    PipelineOptions options = preset(preset_name());
    options.engine = "cpu";  // what CUDA's runtime takes of the host is its own affair
    options.threads = threads;
    options.perspective.disparities = 32;
    Pipeline pipeline(options, frames.front().calibration);
    const auto process = [&] {
      for (const synth::SyntheticPair& frame : frames) pipeline.process(frame.left.view(), frame.right.view());
    };
    process();
    process();
    std::size_t before = allocations()->count;
    process();
    EXPECT_EQ(allocations()->count - before, 0U) << threads << " threads";
    // The rows of a tracked road and the blur are measured again now and then.
    PipelineState due = pipeline.carried();
    due.frames_since_rows = due.frames_since_blur = 1000;
    pipeline.restore(due);
    before = allocations()->count;
    process();
    EXPECT_LT(pipeline.carried().frames_since_rows, 1000);
    EXPECT_EQ(allocations()->count - before, 0U) << threads << " threads, rows and blur measured";
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, PresetAllocations,
                         testing::Combine(testing::ValuesIn(preset_names()), testing::Values(0, 8)),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "Noise" + std::to_string(std::get<1>(test.param));
                         });

/// Most bytes that matching needs beyond the images and maps that exist before.
std::size_t matching_memory(int width, int height, int disparities, const MatcherOptions& options) {
  const auto pair = test::textured_pair(width, height, [](double, double) { return 10; });
  MatchMaps maps;
  maps.disparity.resize(width, height);
  maps.variance.resize(width, height);
  maps.winner.resize(width, height);
  maps.target_winner.resize(width, height);
  const auto engine = make_engine("cpu", 2);
  reset_peak();
  const std::size_t before = allocations()->live_bytes;
  engine->match({pair.reference, pair.target, nullptr, disparities}, options, maps);
  return allocations()->peak_bytes - before;
}

TEST(MatchingMemory, DoesNotGrowWithHeight) {
  SKIP_WITHOUT_COUNT();
  constexpr std::size_t limit = 32U << 20;
  constexpr std::size_t offsets = sizeof(float) * 2079 * (1040 - 130);  // the one map of the whole image
  for (const std::string& name : preset_names()) {
    const MatcherOptions options = preset(name).matcher;
    const std::size_t low = matching_memory(2079, 130, 64, options);
    const std::size_t high = matching_memory(2079, 1040, 64, options);
    EXPECT_LE(high, limit) << name;
    EXPECT_LE(high, low + offsets + (64U << 10)) << name;  // the column where each row begins
    RecordProperty(name + "_kib", static_cast<int>(high >> 10));
  }
}

}  // namespace
}  // namespace roadstereo
