// The engine `cuda` on the GPU of this machine: the whole pipeline with images in device memory, its stages, its
// largest kernels against what they must at least cost, and frames from host to host. Needs nothing but the library.
//   bench_cuda [RUNS]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/memory.hpp"
#include "core/order_statistics.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "stage_floors.hpp"

namespace roadstereo {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  return values.empty() ? 0 : upper_median(values);
}

struct Size {
  int width, height, disparities;
};

synth::SyntheticPair make_pair(const Size& size) {
  synth::Scene scene = synth::named_scene("uav");
  scene.supersampling = 1;
  scene.rig.focal_px *= static_cast<double>(size.width) / scene.rig.width;
  scene.rig.width = size.width;
  scene.rig.height = size.height;
  return synth::render(scene);
}

/// A camera frame in device memory.
class FrameOnDevice {
 public:
  explicit FrameOnDevice(const Frame& frame) : bytes_(frame.bytes.size()), view_(frame.view()) {
    ROADSTEREO_CUDA(
        cudaMemcpyAsync(bytes_.data(), frame.bytes.data(), frame.bytes.size(), cudaMemcpyHostToDevice, nullptr));
    ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
    view_.data = bytes_.data();
  }
  const FrameView& view() const { return view_; }

 private:
  cuda::DeviceArray<std::uint8_t> bytes_;
  FrameView view_;
};

PipelineOptions options_of(const std::string& name, const Size& size) {
  PipelineOptions options = preset(name);
  options.engine = "cuda";
  options.perspective.disparities = size.disparities;
  return options;
}

/// Until memory is made, kernels are loaded, and an idle GPU has raised its clock.
void warm_up(Pipeline& pipeline, const FrameView& left, const FrameView& right) {
  constexpr int min_frames = 10;
  constexpr double min_ms = 300;
  const auto start = Clock::now();
  for (int frame = 0; frame < min_frames || ms_since(start) < min_ms; ++frame) pipeline.process(left, right);
}

struct Goal {
  Size size;
  const char* preset;
  double ms;  ///< 0: none
};

/// Each stage by the device's clock, beside its floor where it has one that is no latency. That of matching is no floor
/// where search ranges leave much out: its ratio may be below 1.
void print_stages(const std::vector<StageTimes>& frames, const StageTimes& floors) {
  const std::pair<const char*, double StageTimes::*> stages[] = {{"prepare", &StageTimes::prepare},
                                                                 {"road model", &StageTimes::road_model},
                                                                 {"perspective", &StageTimes::perspective},
                                                                 {"coarse", &StageTimes::coarse},
                                                                 {"match", &StageTimes::match},
                                                                 {"refinement", &StageTimes::refinement},
                                                                 {"road geometry", &StageTimes::roll},
                                                                 {"transform", &StageTimes::transform}};
  for (const auto& [name, member] : stages) {
    std::vector<double> values;
    for (const StageTimes& times : frames) values.push_back(times.*member);
    const double ms = median(values), floor = floors.*member;
    std::printf("  %-14s %8.4f ms", name, ms);
    if (floor > 0) std::printf("   floor %8.4f ms, ratio %5.1f", floor, ms / floor);
    std::printf("\n");
  }
}

/// The whole pipeline on frames whose road model is known from the frame before.
void time_pipeline(const Goal& goal, int runs) {
  const synth::SyntheticPair pair = make_pair(goal.size);
  const FrameOnDevice left(pair.left), right(pair.right);
  Pipeline pipeline(options_of(goal.preset, goal.size), pair.calibration);
  pipeline.set_device_options({.stream = nullptr, .download = false});
  warm_up(pipeline, left.view(), right.view());
  std::vector<double> ms;
  std::vector<StageTimes> stages;
  for (int run = 0; run < runs; ++run) {
    const auto start = Clock::now();
    const FrameResult& result = pipeline.process(left.view(), right.view());
    ms.push_back(ms_since(start));
    stages.push_back(result.ms);
  }
  const double total = median(ms);
  const double evaluations = 1e-6 * goal.size.width * goal.size.height * goal.size.disparities;
  std::printf("%dx%d, D %d, %s: %.3f ms, %.0f Mde/s", goal.size.width, goal.size.height, goal.size.disparities,
              goal.preset, total, evaluations / (total * 1e-3));
  if (goal.ms > 0)
    std::printf("; goal %.2f ms: %s (%.2f)", goal.ms, total <= goal.ms ? "reached" : "MISSED", total / goal.ms);
  std::printf("\n");
  const StageTimes floors = bench::stage_floors(pipeline.options(), goal.size.width, goal.size.height,
                                                goal.size.disparities, bench::device_peak());
  print_stages(stages, floors);
}

/// Frames from host memory to host memory, by so many pipelines that each have a thread and a stream of their own.
void count_frames(const Size& size, int pipelines, int runs) {
  const synth::SyntheticPair pair = make_pair(size);
  std::vector<Pipeline> all;
  for (int i = 0; i < pipelines; ++i) {
    all.emplace_back(options_of("default", size), pair.calibration);
    warm_up(all.back(), pair.left.view(), pair.right.view());
  }
  std::vector<std::exception_ptr> failures(all.size());
  const auto start = Clock::now();
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < all.size(); ++i) {
    threads.emplace_back([&, i] {
      try {
        for (int run = 0; run < runs; ++run) all[i].process(pair.left.view(), pair.right.view());
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  const double per_second = 1e3 * pipelines * runs / ms_since(start);
  constexpr double goal = 1500;
  std::printf("%dx%d host to host, %d pipeline%s: %7.0f frames/s  goal %.0f: %s\n", size.width, size.height, pipelines,
              pipelines == 1 ? " " : "s", per_second, goal, per_second >= goal ? "reached" : "MISSED");
}

void run(int runs) {
  const cuda::Device device = cuda::find_device();
  if (!device.usable) fail("nothing to measure: ", device.reason);
  const Size usual{640, 360, 32}, large{2079, 1040, 64};
  std::printf(
      "%s\n\nThe whole pipeline, images in device memory, median of %d frames; the floor of matching is that of the "
      "whole range:\n",
      device.name.c_str(), runs);
  for (const Goal& goal : {Goal{usual, "paper", 0.35}, Goal{usual, "default", 0.25}, Goal{usual, "fast", 0},
                           Goal{large, "paper", 0}, Goal{large, "default", 3}, Goal{large, "fast", 0}}) {
    time_pipeline(goal, runs);
  }
  std::printf("\n");
  for (const int pipelines : {1, 2, 3}) count_frames(usual, pipelines, runs);
}

}  // namespace
}  // namespace roadstereo

int main(int argc, char** argv) {
  try {
    const int runs = argc > 1 ? std::atoi(argv[1]) : 200;
    if (runs < 1) {
      std::fprintf(stderr, "bench_cuda: '%s' is no number of runs\n", argv[1]);
      return 2;
    }
    roadstereo::run(runs);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cuda: %s\n", error.what());
    return 1;
  }
}
