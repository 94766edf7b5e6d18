#include "evaluate/ablation_trials.hpp"

#include <limits>

#include "evaluate/ablation_variants.hpp"
#include "evaluate/kitti_frames.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_groups.hpp"
#include "finite_values.hpp"
#include "roadstereo/error.hpp"
#include "settings.hpp"

namespace roadstereo::cli {
namespace {

const std::vector<double>& tolerances_px() {
  static const std::vector<double> tolerances{0.5, 1, 2};
  return tolerances;
}
constexpr std::size_t above_half = 0, above_1 = 1, above_2 = 2;

/// What is collected of one variant.
struct Trials {
  std::vector<DisparityScore> kitti, clean, hard, damage;
  std::vector<double> match_ms, total_ms;
};

Pipeline make_pipeline(const Variant& variant, MethodTask task, const MethodSettings& methods) {
  task.shows_a_road = variant.with_perspective;
  PipelineOptions options = method_options(variant.preset, task, methods);
  apply_settings(variant.settings, options);
  return Pipeline(options, task.pair.calibration);
}

void time_again(Pipeline& pipeline, const StereoPair& pair, Trials& trials) {
  const StageTimes& ms = pipeline.process(pair.left.view(), pair.right.view()).ms;
  trials.match_ms.push_back(ms.match);
  trials.total_ms.push_back(ms.total);
}

void run_kitti(const AblationOptions& options, std::vector<Trials>& trials) {
  for (const KittiFiles& files : find_kitti_frames(options.kitti, "")) {
    const KittiFrame frame = read_kitti_frame(files);
    if (!frame.road) fail(files.name, " has no road mask in ", options.kitti, "/road");
    for (std::size_t i = 0; i < trials.size(); ++i) {
      Pipeline pipeline = make_pipeline(ablation_variants()[i], {frame.pair}, options.methods);
      const FrameResult& result = pipeline.process(frame.pair.left.view(), frame.pair.right.view());
      trials[i].kitti.push_back(score_disparity(result.disparity, frame.truth, frame.road->view(), tolerances_px()));
      time_again(pipeline, frame.pair, trials[i]);
    }
  }
}

void run_rendered(const AblationOptions& options, std::vector<Trials>& trials) {
  const std::vector<synth::Scene> scenes = synth_scenes(options.sizes == "small");
  for (const SynthGroup& group : synth_groups()) {
    const bool clean = &group == &synth_groups().front();
    for (const synth::Scene& scene : scenes) {
      const SynthCase example = make_synth_case(group, scene, options.methods.threads);
      for (std::size_t i = 0; i < trials.size(); ++i) {
        Pipeline pipeline = make_pipeline(ablation_variants()[i], {example.pair, example.disparities}, options.methods);
        const Image<float>& map = pipeline.process(example.pair.left.view(), example.pair.right.view()).disparity;
        auto& scores = clean ? trials[i].clean : trials[i].hard;
        scores.push_back(score_disparity(map, example.truth, example.visible.view(), tolerances_px()));
        trials[i].damage.push_back(score_disparity(map, example.truth, example.damage.view(), tolerances_px()));
        if (clean && options.kitti.empty()) time_again(pipeline, example.pair, trials[i]);
      }
    }
  }
}

AblationFigures summarise(const Trials& trials) {
  const DisparityScore clean = mean_score(trials.clean);
  AblationFigures figures;
  figures.clean_median_px = clean.median_px;
  figures.clean_bad_or_missing = clean.bad_or_missing_share[above_1];
  figures.hard_bad_or_missing = mean_score(trials.hard).bad_or_missing_share[above_1];
  const DisparityScore damage = mean_score(trials.damage);
  figures.damage_rms_px = damage.rms_px;
  figures.damage_bad_or_missing = damage.bad_or_missing_share[above_half];
  figures.match_ms = median(trials.match_ms);
  figures.total_ms = median(trials.total_ms);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  figures.kitti_density = figures.kitti_rms_px = figures.kitti_bad = figures.kitti_bad_or_missing = unknown;
  if (trials.kitti.empty()) return figures;
  const DisparityScore kitti = mean_score(trials.kitti);
  figures.kitti_density = kitti.density();
  figures.kitti_rms_px = kitti.rms_px;
  figures.kitti_bad = kitti.bad_share[above_2];
  figures.kitti_bad_or_missing = kitti.bad_or_missing_share[above_2];
  return figures;
}

}  // namespace

std::vector<AblationFigures> measure_ablation(const AblationOptions& options) {
  std::vector<Trials> trials(ablation_variants().size());
  if (!options.kitti.empty()) run_kitti(options, trials);
  run_rendered(options, trials);
  std::vector<AblationFigures> figures;
  figures.reserve(trials.size());
  for (const Trials& of_variant : trials) figures.push_back(summarise(of_variant));
  return figures;
}

}  // namespace roadstereo::cli
