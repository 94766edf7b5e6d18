#pragma once

#include <algorithm>
#include <cmath>

namespace roadstereo {

/// ln p / (1 − p), of probabilities from one in a million to its opposite.
inline double log_odds(double probability) {
  constexpr double smallest = 1e-6;
  const double p = std::clamp(probability, smallest, 1 - smallest);
  return std::log(p / (1 - p));
}

inline double probability_of(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace roadstereo
