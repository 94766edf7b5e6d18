#pragma once

#include <cmath>

namespace roadstereo {

/// The largest of 1, 2 or 5 times a power of ten that is at most `most`, which is positive.
inline double round_length(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

}  // namespace roadstereo
