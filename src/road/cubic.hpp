#pragma once

#include <cstdint>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Weights of Keys' cubic interpolation for the samples at −1, 0, 1, 2.
struct CubicWeights {
  float before, at, after, beyond;
};

/// The weights around the place f, 0 ≤ f < 1.
template <class Real>
ROADSTEREO_HD inline CubicWeights cubic_weights(Real f) {
  constexpr Real half = Real(0.5), one_and_half = Real(1.5), two_and_half = Real(2.5);
  const Real f2 = f * f, f3 = f2 * f;
  return {static_cast<float>(f2 - half * (f + f3)), static_cast<float>(1 - two_and_half * f2 + one_and_half * f3),
          static_cast<float>(half * f + 2 * f2 - one_and_half * f3), static_cast<float>(half * (f3 - f2))};
}

/// Those of its derivative.
template <class Real>
ROADSTEREO_HD inline CubicWeights cubic_slope_weights(Real f) {
  constexpr Real half = Real(0.5), one_and_half = Real(1.5), four_and_half = Real(4.5);
  const Real f2 = f * f;
  return {static_cast<float>(2 * f - half - one_and_half * f2), static_cast<float>(four_and_half * f2 - 5 * f),
          static_cast<float>(half + 4 * f - four_and_half * f2), static_cast<float>(one_and_half * f2 - f)};
}

/// What lies between four rows.
ROADSTEREO_HD inline float weighted(const CubicWeights& weight, float before, float at, float after, float beyond) {
  return weight.before * before + weight.at * at + weight.after * after + weight.beyond * beyond;
}

/// The grey level at the place f between `at` and `after`, from 0 to white. Keys' cubic interpolation: sharp enough not
/// to flatten texture at half-pixel phases, as linear interpolation does.
ROADSTEREO_HD inline std::int16_t grey_between(float before, float at, float after, float beyond, float f,
                                               float white) {
  const float linear = 0.5F * (after - before);
  const float square = before - 2.5F * at + 2 * after - 0.5F * beyond;
  const float cube = 0.5F * (beyond - before) + 1.5F * (at - after);
  const float value = at + f * (linear + f * (square + f * cube));
  const float positive = value < 0.0F ? 0.0F : value;
  const float bounded = white < positive ? white : positive;
  // Not negative, and lround would keep the loop from being vectorised.
  return static_cast<std::int16_t>(bounded + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
}

}  // namespace roadstereo
