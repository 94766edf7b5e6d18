#include "evaluate/lambda_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "evaluate/rendered_pair.hpp"
#include "evaluate/roll_maps.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {
namespace {

/// Enough for the slowest descent. A descent that does not converge counts as this many.
constexpr int max_iterations = 10000;

RollEstimate fit(const Image<float>& map, const RollOptions& options, int threads) {
  return estimate_roll(map, {}, std::nullopt, 0, options, threads);
}

double closed_form_roll(const Image<float>& map, int threads) {
  RollOptions options;
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
        scene.rig.width /= 2;  // λ is normalised by the number of pixels
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

double LambdaTrial::max() const {
  return *std::max_element(iterations.begin(), iterations.end());
}

std::vector<double> geometric_series(double first, double last, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  const double ratio = last / first;
  for (int i = 0; i < count; ++i) values.push_back(first * std::pow(ratio, i / std::max(1.0, count - 1.0)));
  return values;
}

LambdaTrial run_lambda_trial(double lambda, const std::vector<LambdaMap>& maps, double roll_threshold_rad,
                             int threads) {
  RollOptions options;
  options.solver = RollSolver::gradient_descent;
  options.initial_lambda = lambda;
  options.roll_threshold_rad = roll_threshold_rad;
  options.max_iterations = max_iterations;
  LambdaTrial trial{lambda, {}, 0};
  for (const LambdaMap& map : maps) {
    const RollEstimate estimate = fit(map.disparity, options, threads);
    trial.iterations.push_back(estimate.iterations);
    const double error = std::remainder(estimate.roll_rad - map.minimum_rad, std::numbers::pi);
    trial.max_error_rad = std::max(trial.max_error_rad, std::abs(error));
  }
  return trial;
}

double best_lambda(const std::vector<LambdaTrial>& trials) {
  double min_mean = HUGE_VAL;
  for (const LambdaTrial& trial : trials) min_mean = std::min(min_mean, trial.mean());
  double sum_of_logarithms = 0, count = 0;
  for (const LambdaTrial& trial : trials) {
    if (trial.mean() > min_mean) continue;
    sum_of_logarithms += std::log(trial.lambda);
    count += 1;
  }
  return std::exp(sum_of_logarithms / count);
}

}  // namespace roadstereo::cli
