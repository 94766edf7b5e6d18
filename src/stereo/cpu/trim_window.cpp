#include "stereo/cpu/trim_window.hpp"

#include <cmath>

#include "stereo/window.hpp"

namespace roadstereo::cpu {

MatcherOptions trim_window(const MatcherOptions& options) {
  constexpr double negligible = 1e-3;
  const auto sum_weights = [&](int from_radius) {
    double sum = 0;
    for (const Tap& tap : window_taps(options)) {
      const int distance2 = tap.du * tap.du + tap.dv * tap.dv;
      if (distance2 > from_radius * from_radius)
        sum += std::exp(-distance2 / (options.sigma_space * options.sigma_space));
    }
    return sum;
  };
  const double all = 1 + sum_weights(0);
  MatcherOptions trimmed = options;
  for (int radius = 1; radius <= options.aggregation_radius; ++radius) {
    if (sum_weights(radius) > negligible * all) continue;
    trimmed.aggregation_radius = radius;
    trimmed.aggregation_shape = WindowShape::disc;
    break;
  }
  return trimmed;
}

}  // namespace roadstereo::cpu
