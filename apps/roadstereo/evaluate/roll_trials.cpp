#include "evaluate/roll_trials.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/degrees.hpp"
#include "evaluate/rendered_pair.hpp"
#include "evaluate/roll_maps.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

constexpr double camber = 0.004;  ///< 1 cm at 1.6 m beside the crown
constexpr double outlier_share = 0.05;
constexpr double max_matched_roll_deg = 10;  ///< of matched pairs, in both directions

/// UAV at two heights, and a camera that looks along the road.
constexpr RollView views[] = {{2.6, 60}, {4.0, 45}, {1.65, 20}};

/// Condition of the maps.
struct Condition {
  const char* name;
  bool damaged;
  double outliers;
  double camber;
};
constexpr Condition conditions[] = {{"clean", false, 0, 0},
                                    {"damage", true, 0, 0},
                                    {"damage, 5 % outliers", true, outlier_share, 0},
                                    {"damage, 5 % outliers, camber", true, outlier_share, camber}};

/// `count` evenly spaced angles from −max to +max; max alone if `count` is 1.
std::vector<double> symmetric_angles(double max, int count) {
  std::vector<double> angles;
  angles.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) angles.push_back(count == 1 ? max : max * (2.0 * i / (count - 1) - 1));
  return angles;
}

/// Trials of every solver on one kind of map.
class Trials {
 public:
  Trials(const std::string& maps, int threads) : threads_(threads) {
    for (const NamedSolver& named : roll_solvers()) errors_.push_back({maps, named.name, {}, {}});
  }

  void add(const Image<float>& map, double roll_deg, double roll_rad) {
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      RollOptions options;
      options.solver = roll_solvers()[i].solver;
      const RollEstimate estimate = estimate_roll(map, {}, std::nullopt, 0, options, threads_);
      errors_[i].roll_deg.push_back(roll_deg);
      errors_[i].error_rad.push_back(estimate.roll_rad - roll_rad);
    }
  }

  void move_to(std::vector<RollErrors>& all) { std::move(errors_.begin(), errors_.end(), std::back_inserter(all)); }

 private:
  std::vector<RollErrors> errors_;
  int threads_;
};

void run_rolled_rigs(const Condition& condition, const RollTrialOptions& options, std::vector<RollErrors>& all) {
  Trials trials(std::string("rolled rig, ") + condition.name, options.methods.threads);
  std::uint64_t seed = 0;
  for (const RollView& view : views) {
    for (const double angle : symmetric_angles(options.max_roll_deg, options.angles)) {
      const auto pair =
          synth::render(roll_scene(view, angle, condition.damaged, condition.camber), options.methods.threads);
      Image<float> map = exact_map(pair);
      add_outliers(map, condition.outliers, ++seed);
      trials.add(map, angle, pair.roll_rad);
    }
  }
  trials.move_to(all);
}

void run_rotated_maps(const Condition& condition, Resampling resampling, const RollTrialOptions& options,
                      std::vector<RollErrors>& all) {
  const char* name = resampling == Resampling::nearest ? "rotated map (nearest), " : "rotated map (bilinear), ";
  Trials trials(name + std::string(condition.name), options.methods.threads);
  std::uint64_t seed = 0;
  for (const RollView& view : views) {
    Image<float> level =
        exact_map(synth::render(roll_scene(view, 0, condition.damaged, condition.camber), options.methods.threads));
    add_outliers(level, condition.outliers, ++seed);
    for (const double angle : symmetric_angles(options.max_roll_deg, options.angles)) {
      const double roll = to_radians(angle);
      trials.add(rotate_map(level, roll, resampling), angle, roll);
    }
  }
  trials.move_to(all);
}

std::string solver_name(RollSolver solver) {
  for (const NamedSolver& named : roll_solvers()) {
    if (named.solver == solver) return named.name;
  }
  return "";
}

/// Pairs of one kind of road, matched by a preset: its own roll, and that of the paper's solver on its maps.
std::vector<RollErrors> run_pairs(const std::string& preset_name, double road_camber, const RollTrialOptions& options) {
  constexpr double noise_grey = 2;
  const PipelineOptions pipeline_options = with_settings(preset(preset_name), options.methods);
  const std::string pairs = preset_name == "default" ? "matched pair" : "pair matched by " + preset_name;
  const std::string maps = pairs + (road_camber > 0 ? ", damage, camber" : ", damage");
  RollErrors own{maps, solver_name(pipeline_options.roll.solver), {}, {}};
  RollErrors descent{maps, solver_name(RollSolver::gradient_descent), {}, {}};
  for (const RollView& view : views) {
    for (const double angle : symmetric_angles(max_matched_roll_deg, options.angles)) {
      synth::Scene scene = roll_scene(view, angle, true, road_camber);
      scene.supersampling = 2;
      scene.degradation.noise_grey = noise_grey;
      const synth::SyntheticPair pair = synth::render(scene, options.methods.threads);
      Pipeline pipeline(pipeline_options, pair.calibration);
      const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
      if (!result.roll_found) {
        ++own.lost;
        ++descent.lost;
        continue;
      }
      own.roll_deg.push_back(angle);
      own.error_rad.push_back(result.geometry.roll_rad - pair.roll_rad);
      if (own.solver == descent.solver) continue;
      RollOptions descent_options = pipeline_options.roll;
      descent_options.solver = RollSolver::gradient_descent;
      const RollEstimate estimate =
          estimate_roll(result.disparity, {}, std::nullopt, 0, descent_options, options.methods.threads);
      descent.roll_deg.push_back(angle);
      descent.error_rad.push_back(estimate.roll_rad - pair.roll_rad);
    }
  }
  if (own.solver == descent.solver) return {own};
  return {own, descent};
}

}  // namespace

double RollErrors::mean_rad() const {
  double sum = 0;
  for (const double error : error_rad) sum += std::abs(error);
  return sum / static_cast<double>(error_rad.size());
}

double RollErrors::max_rad() const {
  double max = error_rad.empty() ? NAN : 0;
  for (const double error : error_rad) max = std::max(max, std::abs(error));
  return max;
}

const std::vector<NamedSolver>& roll_solvers() {
  static const std::vector<NamedSolver> solvers{{"gradient_descent", RollSolver::gradient_descent},
                                                {"closed_form", RollSolver::closed_form},
                                                {"robust", RollSolver::robust}};
  return solvers;
}

std::vector<RollErrors> run_exact_trials(const RollTrialOptions& options) {
  std::vector<RollErrors> all;
  for (const Condition& condition : conditions) run_rolled_rigs(condition, options, all);
  for (const Condition& condition : conditions) {
    run_rotated_maps(condition, Resampling::bilinear, options, all);
    run_rotated_maps(condition, Resampling::nearest, options, all);
  }
  return all;
}

std::vector<RollErrors> run_matched_trials(const RollTrialOptions& options) {
  std::vector<RollErrors> all;
  for (const char* name : {"default", "paper"}) {
    for (const double road_camber : {0.0, camber}) {
      for (RollErrors& errors : run_pairs(name, road_camber, options)) all.push_back(std::move(errors));
    }
  }
  return all;
}

}  // namespace roadstereo::cli
