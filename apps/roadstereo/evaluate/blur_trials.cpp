#include "evaluate/blur_trials.hpp"

#include <array>
#include <optional>

#include "benchmark_frames.hpp"
#include "evaluate/rendered_pair.hpp"
#include "evaluation/disparity_score.hpp"
#include "evaluation/peer_matchers.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

constexpr const char* baseline = "SGBM";
constexpr std::array presets{"default", "paper"};

/// Blurred pair with ground truth.
struct BlurredPair {
  StereoPair pair;
  Image<float> truth;
  Image<std::uint8_t> visible;
};

BlurredPair render_blurred(const BlurOptions& options, double length_px, double direction_deg) {
  synth::Scene scene = synth::named_scene(options.scene);
  scene.supersampling = 2;
  scene.degradation.noise_grey = options.noise_grey;
  scene.degradation.motion_blur_px = length_px;
  scene.degradation.motion_blur_angle_deg = direction_deg;
  synth::SyntheticPair rendered = synth::render(scene, options.methods.threads);
  BlurredPair blurred;
  blurred.truth = exact_map(rendered);
  blurred.visible = std::move(rendered.visible);
  blurred.pair = pair_of(rendered);
  return blurred;
}

BlurTrial score(const BlurredPair& blurred, const Image<float>& disparity) {
  constexpr std::array tolerances_px{1.0};
  const DisparityScore score = score_disparity(disparity, blurred.truth, blurred.visible.view(), tolerances_px);
  BlurTrial trial;
  trial.density = score.density;
  trial.rms_px = score.rms_px;
  trial.bad_or_missing = score.bad_or_missing_share.front();
  return trial;
}

Image<float> match_baseline(const StereoPair& pair, const PerspectiveShift& shift, int threads) {
  const PeerPair grey = peer_pair(pair, shift);
  io::PeerMatcher matcher(baseline, shift.disparities);
  matcher.set_pair(grey.reference, grey.target);
  matcher.match();
  Image<float> disparity;
  restore_disparity(matcher.disparity(), shift, 1, threads, disparity);
  return disparity;
}

/// Run every method on one pair.
std::vector<BlurTrial> run_pair(const BlurredPair& blurred, const MethodSettings& methods) {
  std::vector<BlurTrial> trials;
  std::optional<PerspectiveShift> shift;
  for (const char* name : presets) {
    Pipeline pipeline(with_settings(preset(name), methods), blurred.pair.calibration);
    const FrameResult& result = pipeline.process(blurred.pair.left.view(), blurred.pair.right.view());
    if (!shift) shift = result.shift;
    trials.push_back(score(blurred, result.disparity));
    trials.back().method = name;
  }
  trials.push_back(score(blurred, match_baseline(blurred.pair, *shift, methods.threads)));
  trials.back().method = baseline;
  return trials;
}

}  // namespace

void BlurOptions::validate() const {
  if (!(max_px > 0 && max_px <= 100)) fail("--max-length is ", max_px, "; it must be above 0 and at most 100");
  if (steps < 2 || steps > 1000) fail("--steps is ", steps, "; it must be between 2 and 1000");
  if (directions_deg.empty()) fail("--directions is empty; it must have at least one angle");
  if (!(noise_grey >= 0 && noise_grey <= 50)) fail("--noise is ", noise_grey, "; it must be between 0 and 50");
}

const std::vector<std::string>& blur_methods() {
  static const std::vector<std::string> methods{presets[0], presets[1], baseline};
  return methods;
}

std::vector<double> blur_lengths(const BlurOptions& options) {
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(options.steps));
  for (int i = 0; i < options.steps; ++i) lengths.push_back(options.max_px * i / (options.steps - 1));
  return lengths;
}

std::vector<BlurTrial> run_blur_trials(const BlurOptions& options) {
  options.validate();
  std::vector<BlurTrial> all;
  const std::vector<double> lengths = blur_lengths(options);
  Progress progress = Progress::on_terminal(lengths.size() * options.directions_deg.size());
  for (const double length : lengths) {
    for (const double direction : options.directions_deg) {
      for (BlurTrial& trial : run_pair(render_blurred(options, length, direction), options.methods)) {
        trial.length_px = length;
        trial.direction_deg = direction;
        all.push_back(std::move(trial));
      }
      progress.frame_done();
    }
  }
  return all;
}

BlurTrial mean_over_directions(const std::vector<BlurTrial>& trials, const std::string& method, double length_px) {
  BlurTrial mean;
  mean.method = method;
  mean.length_px = length_px;
  double count = 0;
  for (const BlurTrial& trial : trials) {
    if (trial.method != method || trial.length_px != length_px) continue;
    mean.density += trial.density;
    mean.rms_px += trial.rms_px;
    mean.bad_or_missing += trial.bad_or_missing;
    count += 1;
  }
  mean.density /= count;
  mean.rms_px /= count;
  mean.bad_or_missing /= count;
  return mean;
}

}  // namespace roadstereo::cli
