#include "stereo/trim_window.hpp"

#include <cmath>

namespace roadstereo {

std::vector<Tap> trimmed_taps(const MatcherOptions& options) {
  constexpr double negligible = 5e-4;
  std::vector<Tap> taps = window_taps(options);
  const auto squared_distance = [](const Tap& tap) { return tap.du * tap.du + tap.dv * tap.dv; };
  const auto weight_beyond = [&](int squared_radius) {
    double sum = 0;
    for (const Tap& tap : taps) {
      const int distance2 = squared_distance(tap);
      if (distance2 > squared_radius) sum += std::exp(-distance2 / (options.sigma_space * options.sigma_space));
    }
    return sum;
  };
  const double limit = negligible * weight_beyond(-1);
  int squared_radius = 0;
  while (weight_beyond(squared_radius) > limit) ++squared_radius;
  std::erase_if(taps, [&](const Tap& tap) { return squared_distance(tap) > squared_radius; });
  return taps;
}

}  // namespace roadstereo
