#pragma once

#include <algorithm>
#include <cmath>

#include "core/block_row_radius.hpp"
#include "roadstereo/disparity_plane.hpp"
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

/// Length of road that a row covers over the width that a column does, at the centre of the lower half of the image: 1
/// seen from above, Z / h far ahead of a camera at height h. Of d = a0 + a1 v, 0 at infinity, the depth Z = f B / d
/// changes by −Z a1 / d a row. 1 where the plane is behind the camera there.
inline double foreshortening(const DisparityPlane& road, double focal_px, double cy_px, int width, int height) {
  const double v = 0.75 * height, disparity = road.disparity(width / 2.0, v);
  if (!(disparity > 0)) return 1;
  const double slope = road.a1 / disparity;
  return std::max(1.0, std::hypot(focal_px * slope, 1 - (v - cy_px) * slope));
}

/// What the support of a pair follows.
struct PairSupport {
  double correlation = 0;     ///< of blocks on the road (RoadModelEstimate::correlation); 0 is unknown
  double foreshortening = 1;  ///< of the road
};

/// The options for a pair: blocks that are lower in proportion to the foreshortening of the road, down to three rows of
/// nine columns; in noise a larger block, and more weight of the prior in proportion to the uncertainty of the costs.
inline MatcherOptions adapt_support(MatcherOptions options, const PairSupport& pair) {
  if (!options.adapt_support) return options;
  constexpr double min_aspect = 0.22;  // unless less is asked for
  options.block_aspect =
      std::min(options.block_aspect, std::max(min_aspect, options.block_aspect / pair.foreshortening));
  options.block_radius = adapt_radius(options.block_radius, pair.correlation);
  // Of whole rows: a camera that sways does not change the options from frame to frame.
  options.block_aspect = static_cast<double>(block_row_radius(options)) / options.block_radius;
  if (pair.correlation <= 0) return options;
  constexpr double most = 10;  // unless more is asked for
  options.prior_weight =
      std::max(options.prior_weight, std::min(support_scale(pair.correlation) * options.prior_weight, most));
  return options;
}

/// The options that the costs depend on.
inline MatcherOptions without_prior(MatcherOptions options) {
  options.prior_weight = options.prior_truncation_px = 0;
  return options;
}

}  // namespace roadstereo
