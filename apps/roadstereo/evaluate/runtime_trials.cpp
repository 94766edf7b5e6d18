#include "evaluate/runtime_trials.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "benchmark_frames.hpp"
#include "core/max_disparities.hpp"
#include "evaluation/peer_matchers.hpp"
#include "image_size.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {
namespace {

Pipeline make_pipeline(const std::string& name, bool narrow_search, const RuntimeOptions& runtime,
                       const StereoPair& pair) {
  PipelineOptions options = preset(name);
  options.narrow_search = narrow_search;
  options.perspective.disparities = runtime.disparities;
  return Pipeline(with_settings(std::move(options), runtime.methods), pair.calibration);
}

void time_frame(Pipeline& pipeline, const StereoPair& pair, PipelineTimes& times) {
  const FrameResult* result = nullptr;
  times.total.ms.push_back(time_ms([&] { result = &pipeline.process(pair.left.view(), pair.right.view()); }));
  times.roll.ms.push_back(result->ms.roll);
  times.transform.ms.push_back(result->ms.transform);
}

}  // namespace

void RuntimeOptions::validate() const {
  if (disparities < 1 || disparities > max_disparities) {
    fail("--disparities is ", disparities, "; it must be between 1 and ", max_disparities);
  }
  if (runs < 1 || runs > 100000) fail("--runs is ", runs, "; it must be between 1 and 100000");
}

double RuntimeReport::mde_per_s(double ms) const {
  return static_cast<double>(width) * height * disparities * 1e-6 / (ms * 1e-3);
}

RuntimeReport time_methods(const RuntimeOptions& options) {
  options.validate();
  const ImageSize size = parse_image_size("--size", options.size);
  const StereoPair pair = synthetic_pair(size.width, size.height);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = options.methods.threads > 0 ? options.methods.threads : cores;
  RuntimeReport report{size.width, size.height, options.disparities, threads, {}, {}};

  std::vector<Pipeline> pipelines;
  PerspectiveShift shift;
  for (const char* name : {"default", "fast", "paper"}) {
    for (const bool narrow : {true, false}) {
      pipelines.push_back(make_pipeline(name, narrow, options, pair));
      shift = pipelines.back().process(pair.left.view(), pair.right.view()).shift;
      report.pipelines.push_back({narrow ? name : std::string(name) + ", all D", {}, {}, {}});
    }
  }
  const PeerPair grey = peer_pair(pair, shift);
  std::vector<io::PeerMatcher> baselines;
  for (const std::string& name : io::peer_names()) {
    baselines.emplace_back(name, options.disparities);
    baselines.back().set_pair(grey.reference, grey.target);
    baselines.back().match();
    report.baselines.push_back({name, {}});
  }
  for (int run = 0; run < options.runs; ++run) {
    for (std::size_t i = 0; i < pipelines.size(); ++i) time_frame(pipelines[i], pair, report.pipelines[i]);
    for (std::size_t i = 0; i < baselines.size(); ++i) {
      report.baselines[i].ms.push_back(time_ms([&] { baselines[i].match(); }));
    }
  }
  return report;
}

}  // namespace roadstereo::cli
