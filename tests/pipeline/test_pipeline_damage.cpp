// Damage looked for in the last frame of a pipeline.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

synth::Scene small_scene(std::uint32_t seed) {
  synth::Scene scene = damaged_scene();
  scene.rig.width = 320;
  scene.rig.height = 180;
  scene.rig.focal_px = 300;
  scene.supersampling = 2;
  scene.road.seed = seed;
  scene.road.blobs[0].seed = seed;
  return scene;
}

TEST(PipelineDamage, ThrowsBeforeAnyFrame) {
  Pipeline pipeline;
  expect_error([&] { pipeline.find_damage(); }, "no frame");
}

TEST(PipelineDamage, ThrowsAfterRejectedFrame) {
  const synth::SyntheticPair pair = synth::render(small_scene(1));
  Pipeline pipeline(preset("default"), pair.calibration);
  pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_FALSE(pipeline.find_damage().damages.empty());
  EXPECT_THROW(pipeline.process(pair.right.view(), pair.right.view()), Error);
  expect_error([&] { pipeline.find_damage(); }, "no frame");
  pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_FALSE(pipeline.find_damage().damages.empty());
  pipeline.reset();
  expect_error([&] { pipeline.find_damage(); }, "no frame");
}

TEST(PipelineDamage, FindsPotholeOfMatchedPair) {
  synth::Scene scene = damaged_scene();
  scene.supersampling = 2;
  const synth::SyntheticPair pair = synth::render(scene);
  Pipeline pipeline(preset("default"), pair.calibration);
  pipeline.process(pair.left.view(), pair.right.view());
  const DamageMap map = pipeline.find_damage();
  EXPECT_EQ(map.damages.size(), 2U);
  for (const synth::DamageTruth& known : pair.damages) {
    const Damage* found = find(map, pair, known.id);
    ASSERT_NE(found, nullptr);
    EXPECT_NEAR(found->metrics->max_depth_m.value, known.depth_m, 0.08 * known.depth_m);
    EXPECT_NEAR(found->metrics->volume_m3.value, known.volume_m3, 0.15 * known.volume_m3);
    EXPECT_GE(f_score(map.ids, found->id, pair.labels, known.id), 0.85);
  }
}

TEST(PipelineDamage, ReusedResultIsFresh) {
  synth::Scene intact = small_scene(2);
  intact.road.blobs.clear();
  DamageMap reused = find_damage(damaged().metric());
  for (const synth::Scene& scene : {small_scene(1), intact, small_scene(3)}) {
    const synth::SyntheticPair pair = synth::render(scene);
    Pipeline pipeline(preset("default"), pair.calibration);
    pipeline.process(pair.left.view(), pair.right.view());
    pipeline.find_damage(reused);
    EXPECT_EQ(reused.damages.empty(), scene.road.blobs.empty());
    expect_same(pipeline.find_damage(), reused);
  }
}

TEST(PipelineDamage, SixteenPipelinesInSixteenThreadsMatchOne) {
  const std::vector<synth::SyntheticPair> pairs{synth::render(small_scene(1)), synth::render(small_scene(2))};
  const auto find_in = [&](std::size_t k) {
    Pipeline pipeline(preset("default"), pairs[k].calibration);
    pipeline.process(pairs[k].left.view(), pairs[k].right.view());
    return pipeline.find_damage();
  };
  const std::vector<DamageMap> alone{find_in(0), find_in(1)};
  EXPECT_FALSE(alone[0].damages.empty());
  constexpr std::size_t count = 16;
  std::vector<DamageMap> together(count);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < count; ++k) threads.emplace_back([&, k] { together[k] = find_in(k % 2); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < count; ++k) expect_same(alone[k % 2], together[k]);
}

}  // namespace
}  // namespace roadstereo
