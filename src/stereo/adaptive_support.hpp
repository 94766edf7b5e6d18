#pragma once

#include <algorithm>
#include <cmath>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Factor by which the sides of supports grow with the noise of a pair: pixels per support times the signal-to-noise
/// ratio ρ/(1 − ρ) stay about the same, with as many again for what is not noise. 1 for ρ = 0.9 and above.
inline double support_scale(double correlation) {
  constexpr double noise_weight = 3, reference = 0.9, min_correlation = 0.3;
  const auto pixels = [](double rho) { return 1 + noise_weight * (1 - rho) / rho; };
  return std::sqrt(pixels(std::clamp(correlation, min_correlation, reference)) / pixels(reference));
}

/// Radius of a block of `radius` for a pair whose blocks on the road correlate with `correlation`; 0 is unknown.
inline int adapt_radius(int radius, double correlation) {
  constexpr int max_radius = 10;  // of MatcherOptions and CoarseSearchOptions
  if (correlation <= 0) return radius;
  const int adapted = static_cast<int>(std::lround(support_scale(correlation) * radius));
  return std::max(radius, std::min(adapted, max_radius));
}

/// Correlation after downsampling by `factor`, which averages white noise over factor² pixels; 0 stays unknown.
inline double downsampled_correlation(double correlation, int factor) {
  const double signal = factor * factor * correlation;
  return signal / (signal + 1 - correlation);
}

/// The options for a pair whose blocks on the road correlate with `correlation` (RoadModelEstimate::correlation; 0 is
/// unknown and leaves them): a larger block, and as much more weight of the prior as the costs are less certain.
inline MatcherOptions adapt_support(MatcherOptions options, double correlation) {
  if (!options.adapt_support || correlation <= 0) return options;
  options.block_radius = adapt_radius(options.block_radius, correlation);
  constexpr double most = 10;  // unless more is asked for
  options.prior_weight =
      std::max(options.prior_weight, std::min(support_scale(correlation) * options.prior_weight, most));
  return options;
}

/// The options that the costs depend on.
inline MatcherOptions without_prior(MatcherOptions options) {
  options.prior_weight = options.prior_truncation_px = 0;
  return options;
}

}  // namespace roadstereo
