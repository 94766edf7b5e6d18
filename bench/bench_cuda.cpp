// The engine `cuda` on the GPU of this machine: the whole pipeline with images in device memory, its stages and
// kernels, what they must at least cost, frames from host to host, and libSGM where it is installed. Needs nothing but
// the library.
//   bench_cuda [RUNS] [--json FILE]

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
#include "core/cuda/stream.hpp"
#include "core/order_statistics.hpp"
#include "cuda_report.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "stage_floors.hpp"
#if defined(ROADSTEREO_WITH_LIBSGM)
#include <libsgm.h>
#endif

namespace roadstereo::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  return values.empty() ? 0 : upper_median(values);
}

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
    const cuda::StreamView stream(nullptr);
    stream.upload(bytes_.data(), frame.bytes.data(), frame.bytes.size());
    stream.wait();
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

/// Calls `run` until memory is made, kernels are loaded, and an idle GPU has raised its clock.
template <class Run>
void warm_up(Run run) {
  constexpr int min_frames = 10;
  constexpr double min_ms = 300;
  const auto start = Clock::now();
  for (int frame = 0; frame < min_frames || ms_since(start) < min_ms; ++frame) run();
}

template <class Run>
double median_ms(int runs, Run run) {
  std::vector<double> ms;
  for (int i = 0; i < runs; ++i) {
    const auto start = Clock::now();
    run();
    ms.push_back(ms_since(start));
  }
  return median(ms);
}

StageTimes median_of(const std::vector<StageTimes>& frames) {
  StageTimes medians;
  for (double StageTimes::*member :
       {&StageTimes::prepare, &StageTimes::road_model, &StageTimes::perspective, &StageTimes::coarse,
        &StageTimes::match, &StageTimes::refinement, &StageTimes::roll, &StageTimes::transform}) {
    std::vector<double> values;
    for (const StageTimes& times : frames) values.push_back(times.*member);
    medians.*member = median(values);
  }
  return medians;
}

/// The whole pipeline on frames whose road model is known from the frame before. Total, stages and kernels are measured
/// one after the other: events take time.
PipelineTimes time_pipeline(const Size& size, const std::string& preset_name, double goal_ms, int runs) {
  const synth::SyntheticPair pair = make_pair(size);
  const FrameOnDevice left(pair.left), right(pair.right);
  Pipeline pipeline(options_of(preset_name, size), pair.calibration);
  const auto process = [&]() -> const FrameResult& { return pipeline.process(left.view(), right.view()); };
  PipelineTimes times;
  times.size = size;
  times.preset = preset_name;
  times.goal_ms = goal_ms;
  pipeline.set_device_options({.download = false});
  warm_up(process);
  times.ms = median_ms(runs, process);
  pipeline.set_device_options({.download = false, .timing = DeviceTiming::stages});
  std::vector<StageTimes> stages;
  for (int run = 0; run < runs; ++run) stages.push_back(process().ms);
  times.stages = median_of(stages);
  times.floors = stage_floors(pipeline.options(), size.width, size.height, size.disparities, device_peak());
  pipeline.set_device_options({.download = false, .timing = DeviceTiming::kernels});
  for (int run = 0; run < 3; ++run) process();
  times.profile = pipeline.device_profile();
  return times;
}

/// Frames from host memory to host memory, by so many pipelines that each have a thread and a stream of their own.
Throughput count_frames(const Size& size, int pipelines, double goal, int runs) {
  const synth::SyntheticPair pair = make_pair(size);
  std::vector<Pipeline> all;
  for (int i = 0; i < pipelines; ++i) {
    all.emplace_back(options_of("default", size), pair.calibration);
    warm_up([&] { all.back().process(pair.left.view(), pair.right.view()); });
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
  return {size, pipelines, 1e3 * pipelines * runs / ms_since(start), goal};
}

/// libSGM with its default parameters; it takes 64, 128 or 256 disparities, and frames of 8 bits without padding.
#if defined(ROADSTEREO_WITH_LIBSGM)
PeerTimes time_libsgm(const Size& size, int runs) {
  const synth::SyntheticPair pair = make_pair(size);
  const FrameOnDevice left(pair.left), right(pair.right);
  cuda::DeviceArray<std::uint16_t> disparity(static_cast<std::size_t>(size.width) *
                                             static_cast<std::size_t>(size.height));
  sgm::StereoSGM matcher(size.width, size.height, size.disparities, 8, 16, sgm::EXECUTE_INOUT_CUDA2CUDA);
  const auto match = [&] {
    matcher.execute(left.view().data, right.view().data, disparity.data());
    ROADSTEREO_CUDA(cudaDeviceSynchronize());
  };
  warm_up(match);
  return {size, median_ms(runs, match)};
}
#endif

/// Measures all, and writes what is known after each part: one that fails, or does not end in the time it has, leaves
/// the others. Returns whether none failed.
bool run(int runs, const std::string& json) {
  const cuda::Device device = cuda::find_device();
  if (!device.usable) fail("nothing to measure: ", device.reason);
  const Size usual{640, 360, 32}, usual_64{640, 360, 64}, large{2079, 1040, 64};
  struct Goal {
    Size size;
    const char* preset;
    double ms;
  };
  CudaReport report;
  report.device = device.name;
  report.runs = runs;
  bool good = true;
  const auto measure = [&](auto part) {
    try {
      part();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "bench_cuda: %s\n", error.what());
      good = false;
    }
    if (!json.empty()) write_json(report, json);
  };
  std::printf(
      "%s\n\nThe whole pipeline, images in device memory, median of %d frames; goals are those of an H200, the "
      "floor of matching is that of the whole range:\n",
      device.name.c_str(), runs);
  for (const Goal& goal :
       {Goal{usual, "paper", 0.35}, Goal{usual, "default", 0.20}, Goal{usual, "fast", 0}, Goal{usual_64, "default", 0},
        Goal{large, "paper", 0}, Goal{large, "default", 1.5}, Goal{large, "fast", 0}}) {
    measure([&] {
      report.pipelines.push_back(time_pipeline(goal.size, goal.preset, goal.ms, runs));
      print(report.pipelines.back());
    });
  }
  std::printf("\n");
  for (const int pipelines : {1, 2, 3}) {
    measure([&] {
      report.throughput.push_back(count_frames(usual, pipelines, pipelines == 2 ? 1500 : 0, runs));
      print(report.throughput.back());
    });
  }
#if defined(ROADSTEREO_WITH_LIBSGM)
  std::printf("\n");
  for (const Size& size : {usual_64, large}) {
    measure([&] {
      report.peers.push_back(time_libsgm(size, runs));
      print(report.peers.back(), report.pipelines);
    });
  }
#endif
  return good;
}

}  // namespace
}  // namespace roadstereo::bench

int main(int argc, char** argv) {
  try {
    int runs = 200;
    std::string json;
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument == "--json" && i + 1 < argc) {
        json = argv[++i];
      } else if (runs = std::atoi(argv[i]); runs < 1) {
        std::fprintf(stderr, "bench_cuda: '%s' is no number of runs\n", argv[i]);
        return 2;
      }
    }
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // what was measured is seen when the time is over
    return roadstereo::bench::run(runs, json) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cuda: %s\n", error.what());
    return 1;
  }
}
