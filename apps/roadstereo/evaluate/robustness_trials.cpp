#include "evaluate/robustness_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "evaluation/peer_matchers.hpp"
#include "find_damage_or_warn.hpp"
#include "flight/rectified_source.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {
namespace {

/// The robust fit to the truth. Throws Error naming the frame when its truth is too sparse.
DisparityPlane true_plane(const std::string& name, const LabelledFrame& frame, int threads) try {
  return estimate_roll(frame.truth, frame.road->view(), std::nullopt, 0, RollOptions{}, threads).plane;
} catch (const SystemError&) {
  throw;
} catch (const Error& error) {
  fail(name, ": the truth of the road has no plane: ", error.what());
}

/// Largest difference of two planes over the road.
double plane_difference(const DisparityPlane& plane, const DisparityPlane& truth, const LabelledFrame& frame) {
  double largest = 0;
  for (int v = 0; v < frame.truth.height(); ++v) {
    for (int u = 0; u < frame.truth.width(); ++u) {
      if ((*frame.road)(u, v) == 0 || std::isnan(frame.truth(u, v))) continue;
      largest = std::max(largest, std::abs(plane.disparity(u, v) - truth.disparity(u, v)));
    }
  }
  return largest;
}

}  // namespace

const std::vector<std::string>& robustness_methods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"default"};
    all.insert(all.end(), io::peer_names().begin(), io::peer_names().end());
    return all;
  }();
  return names;
}

const std::vector<double>& robustness_tolerances_px() {
  static const std::vector<double> tolerances{0.5, 1, 2, 3};
  return tolerances;
}

bool RobustnessTrial::worse_than(const RobustnessTrial& other) const {
  const bool lost = status == RoadStatus::none, other_lost = other.status == RoadStatus::none;
  if (lost != other_lost) return lost;
  constexpr std::size_t one_pixel = 1;  // of robustness_tolerances_px
  return scores.front().bad_or_missing_share[one_pixel] > other.scores.front().bad_or_missing_share[one_pixel];
}

RobustnessResult run_robustness_trial(const std::string& name, const LabelledFrame& frame,
                                      const MethodSettings& settings) {
  const MethodTask task{frame.pair, frame.disparities};
  RobustnessResult result;
  result.trial.frame = name;
  result.trial.plane_px = std::numeric_limits<double>::infinity();
  Pipeline pipeline(method_options("default", task, settings), frame.pair.calibration);
  RoadModelEstimate road;
  try {
    const FrameResult& processed = pipeline.process(frame.pair.left.view(), frame.pair.right.view());
    road = processed.road;
    result.maps.push_back(processed.disparity);
  } catch (const SystemError&) {
    throw;
  } catch (const Error&) {  // the pair was rejected: every disparity is missing
    result.maps.emplace_back(frame.truth.width(), frame.truth.height(), std::numeric_limits<float>::quiet_NaN());
  }
  result.trial.status = road.status;
  if (road.has_road()) {
    result.trial.plane_px = plane_difference(road.model, true_plane(name, frame, settings.threads), frame);
  }
  for (const std::string& baseline : io::peer_names()) result.maps.push_back(run_method(baseline, task, settings));
  for (const Image<float>& map : result.maps) {
    result.trial.scores.push_back(score_disparity(map, frame.truth, frame.road->view(), robustness_tolerances_px()));
  }
  return result;
}

DriveCounts run_drive(const Drive& drive, const MethodSettings& settings) {
  RectifiedSource source(io::open_source({drive.folder}), drive.calibration);
  const PipelineOptions options = with_settings(preset("default"), settings);
  DriveCounts counts;
  std::optional<Pipeline> pipeline;
  DamageMap damage;
  PairHealth health;
  std::vector<std::string> warnings;
  while (const std::optional<io::SourcePair> pair = source.next()) {
    ++counts.frames;
    if (!pair->error.empty()) {
      ++counts.none;
      continue;
    }
    if (!pipeline) pipeline.emplace(options, source.calibration());
    if (pair->white_level > 0) pipeline->set_white_level(pair->white_level);
    try {
      const FrameResult& result = pipeline->process(pair->left.view(), pair->right.view());
      const RoadStatus status = result.road.status;
      ++(status == RoadStatus::tracked ? counts.tracked : status == RoadStatus::none ? counts.none : counts.found);
      find_damage_or_warn(result, source.calibration(), options.damage, settings.threads, damage, health, warnings);
      counts.damages += static_cast<int>(damage.damages.size());
    } catch (const SystemError&) {
      throw;
    } catch (const Error&) {
      ++counts.none;
    }
  }
  return counts;
}

}  // namespace roadstereo::cli
