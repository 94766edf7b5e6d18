#include "evaluate/synth_scores.hpp"

#include "evaluate/common_pixels.hpp"
#include "evaluate/score_columns.hpp"
#include "progress.hpp"

namespace roadstereo::cli {
namespace {

/// Scores of every method over one set of pixels, by scene.
class SceneScores {
 public:
  void add(const std::vector<Image<float>>& maps, const SynthCase& test_case, ImageView<const std::uint8_t> mask) {
    scores_.resize(maps.size());
    for (std::size_t i = 0; i < maps.size(); ++i) {
      scores_[i].push_back(score_disparity(maps[i], test_case.truth, mask, synth_tolerances_px()));
    }
  }
  std::vector<DisparityScore> means() const {
    std::vector<DisparityScore> means;
    means.reserve(scores_.size());
    for (const auto& of_method : scores_) means.push_back(mean_score(of_method));
    return means;
  }

 private:
  std::vector<std::vector<DisparityScore>> scores_;
};

void score_group(const SynthGroup& group, const std::vector<synth::Scene>& scenes, const MethodSettings& settings,
                 bool clean, SynthScores& scores, Progress& progress) {
  SceneScores visible, damage, common, common_damage;
  for (std::size_t scene = 0; scene < scenes.size(); ++scene) {
    const SynthCase test_case = make_synth_case(group, scenes[scene], settings.threads);
    const MethodTask task{test_case.pair, test_case.disparities, true, synth_frame(group, scene)};
    const std::vector<Image<float>> maps = run_methods(task, settings).maps;
    visible.add(maps, test_case, test_case.visible);
    damage.add(maps, test_case, test_case.damage);
    common.add(maps, test_case, common_pixels(maps, test_case.visible.view()));
    common_damage.add(maps, test_case, common_pixels(maps, test_case.damage.view()));
    for (std::size_t i = 0; clean && i < maps.size(); ++i) {
      scores.biases[i].add(maps[i], test_case.truth, test_case.visible);
    }
    progress.frame_done();
  }
  scores.visible.push_back(visible.means());
  scores.damage.push_back(damage.means());
  scores.common.push_back(common.means());
  scores.common_damage.push_back(common_damage.means());
}

}  // namespace

const std::vector<double>& synth_tolerances_px() {
  static const std::vector<double> tolerances{0.5, 1};
  return tolerances;
}

SynthScores score_synth(const std::vector<synth::Scene>& scenes, const MethodSettings& settings) {
  SynthScores scores;
  scores.biases.resize(method_names(settings).size());
  Progress progress = Progress::on_terminal(synth_groups().size() * scenes.size());
  for (const SynthGroup& group : synth_groups()) {
    score_group(group, scenes, settings, &group == &synth_groups().front(), scores, progress);
  }
  return scores;
}

}  // namespace roadstereo::cli
