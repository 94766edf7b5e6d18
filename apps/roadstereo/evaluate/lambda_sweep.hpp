#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Disparity map for the gradient descent, with the minimum in closed form.
struct LambdaMap {
  Image<float> disparity;
  double minimum_rad = 0;
};

/// Make exact maps of damaged roads at several heights, pitches and rolls.
std::vector<LambdaMap> make_lambda_maps(int threads);

/// Iterations of the gradient descent for one λ(0).
struct LambdaTrial {
  double lambda = 0;
  std::vector<double> iterations;  ///< of eq. (25), e_min_gd, one per map
  double max_error_rad = 0;        ///< maximum distance from the minimum at the end of the descent

  double mean() const;  ///< of the iterations
  double max() const;
};

/// `count` values from `first` to `last` with equal ratios.
std::vector<double> geometric_series(double first, double last, int count);

/// Run the gradient descent from λ(0) = `lambda` on every map.
LambdaTrial run_lambda_trial(double lambda, const std::vector<LambdaMap>& maps, double roll_threshold_rad, int threads);

/// λ(0) with the minimum mean number of iterations; the geometric mean if several have it.
double best_lambda(const std::vector<LambdaTrial>& trials);

}  // namespace roadstereo::cli
