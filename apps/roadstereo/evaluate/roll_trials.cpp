#include "evaluate/roll_trials.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "evaluate/roll_maps.hpp"
#include "roadstereo/pipeline.hpp"
#include "settings.hpp"

namespace roadstereo::cli {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr double camber = 0.004;  ///< 1 cm at 1.6 m beside the crown
constexpr double outlier_share = 0.05;

/// The UAV low and high, and a camera that looks along the road.
constexpr RollView views[] = {{2.6, 60}, {4.0, 45}, {1.65, 20}};

struct Wear {
  const char* name;
  bool damaged;
  double outliers;
  double camber;
};
constexpr Wear wears[] = {{"clean", false, 0, 0},
                          {"damage", true, 0, 0},
                          {"damage, 5 % outliers", true, outlier_share, 0},
                          {"damage, 5 % outliers, camber", true, outlier_share, camber}};

std::vector<double> angles_between(double largest, int count) {
  std::vector<double> angles;
  angles.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) angles.push_back(count == 1 ? largest : largest * (2.0 * i / (count - 1) - 1));
  return angles;
}

/// One kind of map, every solver.
class Trials {
 public:
  Trials(const std::string& maps, int threads) : threads_(threads) {
    for (const NamedSolver& named : roll_solvers()) errors_.push_back({maps, named.name, {}, {}});
  }

  void add(const Image<float>& map, double roll_deg, double roll_rad) {
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      RoadGeometryOptions options;
      options.solver = roll_solvers()[i].solver;
      const RoadGeometry geometry = fit_road_geometry(map, std::nullopt, std::nullopt, 0, options, threads_);
      errors_[i].roll_deg.push_back(roll_deg);
      errors_[i].error_rad.push_back(geometry.roll_rad - roll_rad);
    }
  }

  void move_to(std::vector<RollErrors>& all) { std::move(errors_.begin(), errors_.end(), std::back_inserter(all)); }

 private:
  std::vector<RollErrors> errors_;
  int threads_;
};

void try_rolled_rigs(const Wear& wear, const RollTrialOptions& options, std::vector<RollErrors>& all) {
  Trials trials(std::string("rolled rig, ") + wear.name, options.methods.threads);
  std::uint64_t seed = 0;
  for (const RollView& view : views) {
    for (const double angle : angles_between(options.largest_roll_deg, options.angles)) {
      const auto pair = synth::render(roll_scene(view, angle, wear.damaged, wear.camber), options.methods.threads);
      Image<float> map = exact_map(pair);
      add_outliers(map, wear.outliers, ++seed);
      trials.add(map, angle, pair.roll_rad);
    }
  }
  trials.move_to(all);
}

void try_rotated_maps(const Wear& wear, Resampling resampling, const RollTrialOptions& options,
                      std::vector<RollErrors>& all) {
  const char* name = resampling == Resampling::nearest ? "rotated map (nearest), " : "rotated map (bilinear), ";
  Trials trials(name + std::string(wear.name), options.methods.threads);
  std::uint64_t seed = 0;
  for (const RollView& view : views) {
    Image<float> level =
        exact_map(synth::render(roll_scene(view, 0, wear.damaged, wear.camber), options.methods.threads));
    add_outliers(level, wear.outliers, ++seed);
    for (const double angle : angles_between(options.largest_roll_deg, options.angles)) {
      const double roll = angle * radians_per_degree;
      trials.add(rotate_map(level, roll, resampling), angle, roll);
    }
  }
  trials.move_to(all);
}

RollErrors try_pairs(double road_camber, const RollTrialOptions& options) {
  constexpr double noise_grey = 2;
  PipelineOptions pipeline_options = preset("default");
  pipeline_options.threads = options.methods.threads;
  apply_settings(options.methods.settings, pipeline_options);
  RollErrors errors{road_camber > 0 ? "matched pair, damage, camber" : "matched pair, damage", "robust", {}, {}};
  for (const RollView& view : views) {
    for (const double angle : angles_between(options.largest_matched_roll_deg, options.angles)) {
      synth::Scene scene = roll_scene(view, angle, true, road_camber);
      scene.supersampling = 2;
      scene.degradation.noise_grey = noise_grey;
      const synth::SyntheticPair pair = synth::render(scene, options.methods.threads);
      Pipeline pipeline(pipeline_options, pair.calibration);
      const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
      errors.roll_deg.push_back(angle);
      errors.error_rad.push_back(result.geometry.roll_rad - pair.roll_rad);
    }
  }
  return errors;
}

}  // namespace

double RollErrors::mean_rad() const {
  double sum = 0;
  for (const double error : error_rad) sum += std::abs(error);
  return sum / static_cast<double>(error_rad.size());
}

double RollErrors::largest_rad() const {
  double largest = 0;
  for (const double error : error_rad) largest = std::max(largest, std::abs(error));
  return largest;
}

const std::vector<NamedSolver>& roll_solvers() {
  static const std::vector<NamedSolver> solvers{{"gradient_descent", RollSolver::gradient_descent},
                                                {"closed_form", RollSolver::closed_form},
                                                {"robust", RollSolver::robust}};
  return solvers;
}

std::vector<RollErrors> try_exact_maps(const RollTrialOptions& options) {
  std::vector<RollErrors> all;
  for (const Wear& wear : wears) try_rolled_rigs(wear, options, all);
  for (const Wear& wear : wears) {
    try_rotated_maps(wear, Resampling::bilinear, options, all);
    try_rotated_maps(wear, Resampling::nearest, options, all);
  }
  return all;
}

std::vector<RollErrors> try_matched_maps(const RollTrialOptions& options) {
  return {try_pairs(0, options), try_pairs(camber, options)};
}

}  // namespace roadstereo::cli
