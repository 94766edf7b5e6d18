#include "evaluate/lambda_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "evaluate/roll_maps.hpp"
#include "roadstereo/road_geometry.hpp"

namespace roadstereo::cli {
namespace {

/// Enough for the slowest rate; what does not stop by then counts as this many.
constexpr int most_iterations = 10000;

RoadGeometry fit(const Image<float>& map, const RoadGeometryOptions& options, int threads) {
  return fit_road_geometry(map, std::nullopt, std::nullopt, 0, options, threads);
}

double closed_form_roll(const Image<float>& map, int threads) {
  RoadGeometryOptions options;
  options.solver = RollSolver::closed_form;
  return fit(map, options, threads).roll_rad;
}

}  // namespace

std::vector<LambdaMap> make_lambda_maps(int threads) {
  constexpr double heights_m[] = {1.65, 2.6, 4.0};
  constexpr double pitches_deg[] = {20, 45, 65};
  constexpr double rolls_deg[] = {-15, -6, -2, -0.5, 1, 4, 10};
  std::vector<LambdaMap> maps;
  for (const double height : heights_m) {
    for (const double pitch : pitches_deg) {
      for (const double roll : rolls_deg) {
        synth::Scene scene = roll_scene({height, pitch}, roll, true, 0);
        scene.rig.width /= 2;  // λ is normalised: the number of pixels does not matter
        scene.rig.height /= 2;
        scene.rig.focal_px /= 2;
        Image<float> map = exact_map(synth::render(scene, threads));
        const double minimum = closed_form_roll(map, threads);
        maps.push_back({std::move(map), minimum});
      }
    }
  }
  return maps;
}

double LambdaTrial::mean() const {
  return std::accumulate(iterations.begin(), iterations.end(), 0.0) / static_cast<double>(iterations.size());
}

double LambdaTrial::most() const {
  return *std::max_element(iterations.begin(), iterations.end());
}

std::vector<double> geometric_series(double lowest, double highest, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  const double ratio = highest / lowest;
  for (int i = 0; i < count; ++i) values.push_back(lowest * std::pow(ratio, i / std::max(1.0, count - 1.0)));
  return values;
}

LambdaTrial try_lambda(double lambda, const std::vector<LambdaMap>& maps, double roll_threshold_rad, int threads) {
  RoadGeometryOptions options;
  options.solver = RollSolver::gradient_descent;
  options.initial_lambda = lambda;
  options.roll_threshold_rad = roll_threshold_rad;
  options.max_iterations = most_iterations;
  LambdaTrial trial{lambda, {}, 0};
  for (const LambdaMap& map : maps) {
    const RoadGeometry geometry = fit(map.disparity, options, threads);
    trial.iterations.push_back(geometry.iterations);
    const double error = std::remainder(geometry.roll_rad - map.minimum_rad, std::numbers::pi);
    trial.largest_error_rad = std::max(trial.largest_error_rad, std::abs(error));
  }
  return trial;
}

double best_lambda(const std::vector<LambdaTrial>& trials) {
  double least = HUGE_VAL;
  for (const LambdaTrial& trial : trials) least = std::min(least, trial.mean());
  double logarithms = 0, count = 0;
  for (const LambdaTrial& trial : trials) {
    if (trial.mean() > least) continue;
    logarithms += std::log(trial.lambda);
    count += 1;
  }
  return std::exp(logarithms / count);
}

}  // namespace roadstereo::cli
