// Every stage of the pipeline on its own: how its time grows with the number of pixels and of disparities.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "roadstereo/alignment.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "stereo/coarse/coarse_search.hpp"

namespace {

using namespace roadstereo;

/// A pair with all that the stages leave for each other.
struct Frame {
  synth::SyntheticPair pair;
  GreyImage left, right, target;
  std::vector<int> first_column;
  PerspectiveShift shift;
  RoadModelEstimate road;
  MatchMaps maps;
  Image<float> disparity, transformed;
  RollEstimate geometry;
  DamageMap damage;

  Frame(int width, int height, int disparities) {
    synth::Scene scene = synth::named_scene("uav");
    scene.supersampling = 1;
    scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
    scene.rig.width = width;
    scene.rig.height = height;
    pair = synth::render(scene);
    to_grey(pair.left.view(), 0, left);
    to_grey(pair.right.view(), 0, right);
    road.model = pair.plane;
    road.status = RoadStatus::found;
    PerspectiveOptions options;
    options.disparities = disparities;
    shift = plan_perspective(road, pair.calibration, width, height, options);
    transform_target(right, shift, 0, target, first_column);
    MatcherOptions every_pixel;
    every_pixel.pixel_step = 1;
    make_engine("cpu", 0)->match(input(), every_pixel, maps);
    restore_disparity(maps.disparity, shift, 1, 0, disparity);
    geometry = estimate_roll(disparity, {}, road.model, 0, {});
    transform_disparity(disparity, geometry, 0, {}, 0, transformed);
  }
  MatchInput input() const { return {left, target, first_column.data(), shift.disparities}; }
};

void report(benchmark::State& state, const Frame& frame) {
  state.counters["Mde/s"] =
      benchmark::Counter(static_cast<double>(frame.left.pixels()) * frame.shift.disparities * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate);
}

/// A frame of the size and disparities in the benchmark's arguments.
Frame make_frame(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), static_cast<int>(state.range(2))};
}

/// Runs `stage(frame)`.
template <class Stage>
void run(benchmark::State& state, const Stage& stage) {
  Frame frame = make_frame(state);
  for (auto _ : state) stage(frame);
  report(state, frame);
}

/// Matching all disparities, with `threads` threads.
void match(benchmark::State& state, const std::string& preset_name, int threads) {
  const auto engine = make_engine("cpu", threads);
  const MatcherOptions options = preset(preset_name).matcher;
  run(state, [&](Frame& frame) { engine->match(frame.input(), options, frame.maps); });
}

/// Runs `stage(result, options, frame)` on what the pipeline makes of the frame, with its damage.
template <class Stage>
void run_on_result(benchmark::State& state, const Stage& stage) {
  Frame frame = make_frame(state);
  PipelineOptions options = preset("default");
  options.perspective.disparities = frame.shift.disparities;
  Pipeline pipeline(options, frame.pair.calibration);
  const FrameResult& result = pipeline.process(frame.pair.left.view(), frame.pair.right.view());
  find_damage(result, frame.pair.calibration, options.damage, 0, frame.damage);
  for (auto _ : state) stage(result, options.damage, frame);
  report(state, frame);
}

/// Damage, with the memory of an earlier result.
void damage(benchmark::State& state) {
  run_on_result(state, [](const FrameResult& result, const DamageOptions& options, Frame& frame) {
    find_damage(result, frame.pair.calibration, options, 0, frame.damage);
  });
}

void health(benchmark::State& state) {
  run_on_result(state, [](const FrameResult& result, const DamageOptions& options, Frame& frame) {
    benchmark::DoNotOptimize(measure_health(result, frame.damage, frame.pair.calibration, options));
  });
}

template <class Body>
benchmark::internal::Benchmark* add(const std::string& name, Body body) {
  return benchmark::RegisterBenchmark(name.c_str(), body)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

void register_all() {
  const std::vector<std::vector<std::int64_t>> sizes{{640, 360, 32}, {1242, 375, 64}, {2079, 1040, 64}};
  const auto add_stage = [&](const std::string& name, auto stage) {
    auto* entry = add("stage/" + name, [stage](benchmark::State& state) { run(state, stage); });
    for (const auto& size : sizes) entry->Args(size);
  };
  add_stage("grey", [](Frame& f) { to_grey(f.pair.left.view(), 0, f.left); });
  add_stage("row_alignment", [](Frame& f) { measure_row_alignment(f.left, f.right, 0); });
  add_stage("estimate_road", [](Frame& f) { estimate_road_model(f.left, f.right, f.pair.calibration, {}); });
  add_stage("verify_road", [](Frame& f) {
    verify_road_model(f.left, f.right, {f.road.model, f.road.inlier_share}, f.pair.calibration, {});
  });
  add_stage("transform_target", [](Frame& f) { transform_target(f.right, f.shift, 0, f.target, f.first_column); });
  add_stage("restore_disparity", [](Frame& f) { restore_disparity(f.maps.disparity, f.shift, 1, 0, f.disparity); });
  add_stage("roll", [](Frame& f) { estimate_roll(f.disparity, {}, f.road.model, 0, {}); });
  add_stage("transform_disparity",
            [](Frame& f) { transform_disparity(f.disparity, f.geometry, 0, {}, 0, f.transformed); });
  for (auto* after : {add("stage/damage", damage), add("stage/health", health)}) {
    for (const auto& size : sizes) after->Args(size);
  }
  auto* coarse = add("stage/coarse_search", [](benchmark::State& state) {
    CoarseSearch search({}, 0);
    run(state, [&](Frame& frame) { search.find(frame.input(), frame.shift); });
  });
  for (const auto& size : sizes) coarse->Args(size);

  for (const std::string& name : preset_names()) {
    for (const int threads : {1, 2}) {
      const std::string label = "match/" + name + "/threads:" + std::to_string(threads);
      auto* entry = add(label, [name, threads](benchmark::State& state) { match(state, name, threads); });
      for (const auto& size : sizes) entry->Args(size);
      if (threads == 1) {
        for (const std::int64_t d : {16, 48, 64, 96, 128}) entry->Args({640, 360, d});
        for (const std::int64_t scale : {1, 3, 4}) entry->Args({320 * scale, 180 * scale, 32});
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("engine", engines().front().description);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
