#include "evaluate/flight_trials.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "flight_path.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"
#include "roadstereo/warning.hpp"
#include "scene_options.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {
namespace {

Pipeline make_pipeline(const FlightOptions& options, const StereoCalibration& calibration) {
  return Pipeline(with_settings(preset(options.preset), options.methods), calibration);
}

/// ψ of a plane: a1 = α1 cos ψ, a2 = −α1 sin ψ.
double roll_of(const DisparityPlane& plane) {
  return std::atan(-plane.a2 / plane.a1);
}

RoadError road_error(const DisparityPlane& plane, double roll_rad, const synth::SyntheticPair& truth) {
  constexpr double min_px = 1;  // of change over the image; less if the camera looks straight down
  RoadError error;
  const bool observable = std::hypot(truth.plane.a1, truth.plane.a2) * truth.disparity.height() > min_px;
  error.roll_rad = observable ? std::abs(roll_rad - truth.roll_rad) : std::numeric_limits<double>::quiet_NaN();
  for (int v = 0; v < truth.disparity.height(); ++v) {
    for (int u = 0; u < truth.disparity.width(); ++u) {
      if (std::isnan(truth.disparity(u, v))) continue;
      error.plane_px = std::max(error.plane_px, std::abs(plane.disparity(u, v) - truth.plane.disparity(u, v)));
    }
  }
  return error;
}

/// Errors of a result; infinite where no road was found.
StageErrors compare(const FrameResult& result, const synth::SyntheticPair& truth) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  StageErrors errors{{infinite, infinite}, {infinite, infinite}};
  if (result.road.has_road()) errors.before = road_error(result.road.model, roll_of(result.road.model), truth);
  if (result.roll_found) errors.after = road_error(result.geometry.plane, result.geometry.roll_rad, truth);
  return errors;
}

FlightTrial run_frame(const synth::SyntheticPair& pair, std::vector<Pipeline>& pipelines, Pipeline& fresh) {
  FlightTrial frame;
  for (Pipeline& pipeline : pipelines) {
    const FrameResult* result = nullptr;
    const std::clock_t start = std::clock();
    frame.times_ms.push_back(time_ms([&] { result = &pipeline.process(pair.left.view(), pair.right.view()); }));
    frame.cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    frame.tracked = compare(*result, pair);
    frame.reestimated = result->road.status != RoadStatus::tracked;
    const auto anew = std::find_if(result->warnings.begin(), result->warnings.end(),
                                   [](const std::string& warning) { return warning_code(warning) == "road-anew"; });
    frame.reason = anew == result->warnings.end() ? "" : *anew;
  }
  fresh.reset();
  frame.fresh = compare(fresh.process(pair.left.view(), pair.right.view()), pair);
  return frame;
}

}  // namespace

void FlightOptions::validate() const {
  if (frames < 2 || frames > 100000) fail("--frames is ", frames, "; it must be between 2 and 100000");
  if (passes < 1 || passes > 100) fail("--passes is ", passes, "; it must be between 1 and 100");
}

std::vector<FlightTrial> run_flight_trials(const FlightOptions& options) {
  options.validate();
  const synth::FlightPath path = parse_flight(options.flight);
  const synth::Scene first =
      make_scene({.name = options.scene, .size = options.size, .supersampling = options.supersampling});
  const StereoCalibration calibration = first.rig.calibration();
  for (int i = 0; i < options.frames; ++i) synth::flight_frame(first, path, i);  // throws before anything is rendered
  std::vector<Pipeline> pipelines;
  pipelines.reserve(static_cast<std::size_t>(options.passes));
  for (int pass = 0; pass < options.passes; ++pass) {
    pipelines.push_back(make_pipeline(options, calibration));
    if (!options.cold) pipelines.back().warm_up(first.rig.width, first.rig.height);
  }
  Pipeline fresh = make_pipeline(options, calibration);
  std::vector<FlightTrial> frames;
  frames.reserve(static_cast<std::size_t>(options.frames));
  Progress progress = Progress::on_terminal(static_cast<std::size_t>(options.frames));
  for (int i = 0; i < options.frames; ++i) {
    frames.push_back(run_frame(synth::render(synth::flight_frame(first, path, i)), pipelines, fresh));
    progress.frame_done();
  }
  return frames;
}

}  // namespace roadstereo::cli
