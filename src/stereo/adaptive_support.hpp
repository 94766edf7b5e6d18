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

/// The options for a pair whose blocks on the road correlate with `correlation` (RoadModelEstimate::correlation; 0 is
/// unknown and leaves them): a larger block, and as much more weight of the prior as the costs are less certain.
inline MatcherOptions adapt_support(MatcherOptions options, double correlation) {
  constexpr int max_radius = 7;
  if (!options.adapt_support || correlation <= 0) return options;
  const double scale = support_scale(correlation);
  const int radius = static_cast<int>(std::lround(scale * options.block_radius));
  options.block_radius = std::max(options.block_radius, std::min(radius, max_radius));
  options.prior_weight = std::min(scale * options.prior_weight, 10.0);
  return options;
}

}  // namespace roadstereo
