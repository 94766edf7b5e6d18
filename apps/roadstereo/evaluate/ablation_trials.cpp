#include "evaluate/ablation_trials.hpp"

#include <limits>

#include "evaluate/ablation_variants.hpp"
#include "evaluate/kitti_frames.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_groups.hpp"
#include "finite_values.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "settings.hpp"

namespace roadstereo::cli {
namespace {

const std::vector<double>& tolerances_px() {
  static const std::vector<double> tolerances{0.5, 1, 2};
  return tolerances;
}
constexpr std::size_t above_half = 0, above_1 = 1, above_2 = 2;

/// Scores and times of one variant.
struct Trials {
  std::vector<DisparityScore> kitti, clean, hard, damage;
  std::vector<double> match_ms, total_ms;
};

Pipeline make_pipeline(const Variant& variant, MethodTask task, const MethodSettings& methods) {
  task.is_road = variant.with_perspective;
  PipelineOptions options = method_options(variant.preset, task, methods);
  apply_settings(variant.settings, options);
  return Pipeline(options, task.pair.calibration);
}

/// Process a pair that has been processed before, and add its times.
void time_second_pass(Pipeline& pipeline, const StereoPair& pair, Trials& trials) {
  const StageTimes& ms = pipeline.process(pair.left.view(), pair.right.view()).ms;
  trials.match_ms.push_back(ms.match);
  trials.total_ms.push_back(ms.total);
}

void run_kitti(const AblationOptions& options, std::vector<Trials>& trials) {
  const std::vector<KittiFiles> frames = find_kitti_frames(options.kitti, "");
  Progress progress = Progress::on_terminal(frames.size());
  for (const KittiFiles& files : frames) {
    const LabelledFrame frame = read_kitti_frame(files);
    if (!frame.road) fail(options.kitti, "/road: frame ", files.name, " has no road mask");
    for (std::size_t i = 0; i < trials.size(); ++i) {
      Pipeline pipeline = make_pipeline(ablation_variants()[i], {frame.pair, frame.disparities}, options.methods);
      const FrameResult& result = pipeline.process(frame.pair.left.view(), frame.pair.right.view());
      trials[i].kitti.push_back(score_disparity(result.disparity, frame.truth, frame.road->view(), tolerances_px()));
      time_second_pass(pipeline, frame.pair, trials[i]);
    }
    progress.frame_done();
  }
}

void run_rendered(const AblationOptions& options, std::vector<Trials>& trials) {
  const std::vector<synth::Scene> scenes = synth_scenes(options.sizes == "small");
  Progress progress = Progress::on_terminal(synth_groups().size() * scenes.size());
  for (const SynthGroup& group : synth_groups()) {
    const bool clean = &group == &synth_groups().front();
    for (const synth::Scene& scene : scenes) {
      const SynthCase test_case = make_synth_case(group, scene, options.methods.threads);
      for (std::size_t i = 0; i < trials.size(); ++i) {
        Pipeline pipeline =
            make_pipeline(ablation_variants()[i], {test_case.pair, test_case.disparities}, options.methods);
        const Image<float>& map = pipeline.process(test_case.pair.left.view(), test_case.pair.right.view()).disparity;
        auto& scores = clean ? trials[i].clean : trials[i].hard;
        scores.push_back(score_disparity(map, test_case.truth, test_case.visible.view(), tolerances_px()));
        trials[i].damage.push_back(score_disparity(map, test_case.truth, test_case.damage.view(), tolerances_px()));
        if (clean && options.kitti.empty()) time_second_pass(pipeline, test_case.pair, trials[i]);
      }
      progress.frame_done();
    }
  }
}

AblationResult summarise(const Trials& trials) {
  const DisparityScore clean = mean_score(trials.clean);
  AblationResult result;
  result.clean_median_px = clean.median_px;
  result.clean_bad_or_missing = clean.bad_or_missing_share[above_1];
  result.hard_bad_or_missing = mean_score(trials.hard).bad_or_missing_share[above_1];
  const DisparityScore damage = mean_score(trials.damage);
  result.damage_rms_px = damage.rms_px;
  result.damage_bad_or_missing = damage.bad_or_missing_share[above_half];
  result.match_ms = median(trials.match_ms);
  result.total_ms = median(trials.total_ms);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  result.kitti_density = result.kitti_rms_px = result.kitti_bad = result.kitti_bad_or_missing = nan;
  if (trials.kitti.empty()) return result;
  const DisparityScore kitti = mean_score(trials.kitti);
  result.kitti_density = kitti.density;
  result.kitti_rms_px = kitti.rms_px;
  result.kitti_bad = kitti.bad_share[above_2];
  result.kitti_bad_or_missing = kitti.bad_or_missing_share[above_2];
  return result;
}

}  // namespace

std::vector<AblationResult> measure_ablation(const AblationOptions& options) {
  std::vector<Trials> trials(ablation_variants().size());
  if (!options.kitti.empty()) run_kitti(options, trials);
  run_rendered(options, trials);
  std::vector<AblationResult> results;
  results.reserve(trials.size());
  for (const Trials& of_variant : trials) results.push_back(summarise(of_variant));
  return results;
}

}  // namespace roadstereo::cli
