// Every engine of the registry, and the whole pipeline on a first and on a following frame, beside OpenCV's matchers on
// the same frames.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"

namespace {

using namespace roadstereo;

struct Work {
  int width, height, disparities;
};
constexpr Work works[] = {{640, 360, 32}, {1242, 375, 64}, {2079, 1040, 64}};

/// A rectified pair of a road, the target already transformed as the pipeline does it.
struct MatchableFrame {
  synth::SyntheticPair pair;
  GreyImage reference, target;
  std::vector<int> first_column;
  cv::Mat reference_bytes, target_bytes;

  explicit MatchableFrame(const Work& work) {
    synth::Scene scene = synth::named_scene("uav");
    scene.supersampling = 1;
    scene.rig.focal_px *= static_cast<double>(work.width) / scene.rig.width;
    scene.rig.width = work.width;
    scene.rig.height = work.height;
    pair = synth::render(scene);
    GreyImage right;
    to_grey(pair.left.view(), 0, reference);
    to_grey(pair.right.view(), 0, right);
    PerspectiveShift shift;
    shift.road = pair.plane;
    shift.delta_p = work.disparities / 2;
    shift.disparities = work.disparities;
    transform_target(right, shift, 0, target, first_column);
    reference_bytes = to_bytes(reference);
    target_bytes = to_bytes(target);
  }

  static cv::Mat to_bytes(const GreyImage& image) {
    cv::Mat bytes(image.height(), image.width(), CV_8U);
    for (int v = 0; v < image.height(); ++v) {
      for (int u = 0; u < image.width(); ++u)
        bytes.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(image(u, v) / 16);
    }
    return bytes;
  }
};

/// Milliseconds of one call.
template <class Call>
double time_call(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

cv::Ptr<cv::StereoMatcher> make_sgbm(int disparities, int mode) {
  return cv::StereoSGBM::create(0, disparities, 5, 200, 800, 1, 63, 10, 100, 2, mode);
}

/// Times `call`, the first one left out, and OpenCV's MODE_SGBM on the same frame in turn with it, so that both see the
/// same machine. Reports the medians, their ratio and the disparity evaluations per second.
template <class Call>
void compare(benchmark::State& state, const Work& work, const MatchableFrame& frame, const Call& call) {
  const auto sgbm = make_sgbm(work.disparities, cv::StereoSGBM::MODE_SGBM);
  cv::Mat disparity;
  const auto peer = [&] { sgbm->compute(frame.reference_bytes, frame.target_bytes, disparity); };
  call();
  peer();
  std::vector<double> own_ms, peer_ms;
  for (auto _ : state) {
    own_ms.push_back(time_call(call));
    state.SetIterationTime(own_ms.back() * 1e-3);
    peer_ms.push_back(time_call(peer));
  }
  const double evaluations = static_cast<double>(work.width) * work.height * work.disparities;
  state.counters["median_ms"] = median(own_ms);
  state.counters["Mde/s"] = evaluations * 1e-6 / (median(own_ms) * 1e-3);
  state.counters["of_SGBM"] = median(own_ms) / median(peer_ms);
}

void match(benchmark::State& state, const std::string& engine_name, const std::string& preset_name, const Work& work) {
  const MatchableFrame frame(work);
  const MatcherOptions options = preset(preset_name).matcher;
  const auto engine = make_engine(engine_name, 0);
  MatchMaps maps;
  compare(state, work, frame, [&] {
    engine->match({frame.reference, frame.target, frame.first_column.data(), work.disparities}, options, maps);
  });
}

void match_opencv(benchmark::State& state, const cv::Ptr<cv::StereoMatcher>& matcher, const Work& work) {
  const MatchableFrame frame(work);
  cv::Mat disparity;
  compare(state, work, frame, [&] { matcher->compute(frame.reference_bytes, frame.target_bytes, disparity); });
}

/// The whole pipeline; `fresh` forgets the last frame, so that the road model is found anew.
void process(benchmark::State& state, const std::string& preset_name, bool fresh, const Work& work) {
  const MatchableFrame frame(work);
  PipelineOptions options = preset(preset_name);
  options.perspective.disparities = work.disparities;
  Pipeline pipeline(options, frame.pair.calibration);
  compare(state, work, frame, [&] {
    if (fresh) pipeline.reset();
    pipeline.process(frame.pair.left.view(), frame.pair.right.view());
  });
}

void register_work(const Work& work) {
  const std::string size =
      std::to_string(work.width) + "x" + std::to_string(work.height) + "x" + std::to_string(work.disparities);
  const auto add = [&](const std::string& name, auto body) {
    benchmark::RegisterBenchmark((size + "/" + name).c_str(), body)->Unit(benchmark::kMillisecond)->UseManualTime();
  };
  for (const EngineInfo& info : engines()) {
    if (info.exact) continue;
    for (const std::string& name : preset_names()) {
      add(info.name + "/" + name, [=](benchmark::State& state) { match(state, info.name, name, work); });
    }
  }
  for (const std::string& name : preset_names()) {
    add("pipeline/" + name + "/first", [=](benchmark::State& state) { process(state, name, true, work); });
    add("pipeline/" + name + "/next", [=](benchmark::State& state) { process(state, name, false, work); });
  }
  const std::pair<const char*, int> modes[] = {{"SGBM", cv::StereoSGBM::MODE_SGBM},
                                               {"SGBM_3WAY", cv::StereoSGBM::MODE_SGBM_3WAY},
                                               {"HH4", cv::StereoSGBM::MODE_HH4}};
  for (const auto& [name, mode] : modes) {
    const cv::Ptr<cv::StereoMatcher> matcher = make_sgbm(work.disparities, mode);
    add(std::string("opencv/") + name, [=](benchmark::State& state) { match_opencv(state, matcher, work); });
  }
  add("opencv/BM",
      [=](benchmark::State& state) { match_opencv(state, cv::StereoBM::create(work.disparities, 11), work); });
}

}  // namespace

int main(int argc, char** argv) {
  for (const Work& work : works) register_work(work);
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("SIMD target", engines().front().description);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
