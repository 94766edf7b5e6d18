#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// A disparity map to descend on, and its minimum in closed form.
struct LambdaMap {
  Image<float> disparity;
  double minimum_rad = 0;
};

/// Exact maps of damaged roads, from several heights and pitches, under several rolls.
std::vector<LambdaMap> make_lambda_maps(int threads);

/// What one λ(0) costs, over all maps.
struct LambdaTrial {
  double lambda = 0;
  std::vector<double> iterations;  ///< of eq. e_min_gd, one per map
  double largest_error_rad = 0;    ///< distance from the minimum where the descent stopped

  double mean() const;
  double most() const;
};

/// `count` values from `lowest` to `highest` with equal ratios.
std::vector<double> geometric_series(double lowest, double highest, int count);

LambdaTrial try_lambda(double lambda, const std::vector<LambdaMap>& maps, double roll_threshold_rad, int threads);

/// The value with the smallest mean number of iterations; the geometric middle of all that share it.
double best_lambda(const std::vector<LambdaTrial>& trials);

}  // namespace roadstereo::cli
