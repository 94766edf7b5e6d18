#pragma once

#include <cstdint>

namespace roadstereo::synth {

/// Cubic step from 0 at x = 0 to 1 at x = 1.
template <class Number>
Number smooth_step(Number x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * (3 - 2 * x);
}

/// Gradient noise with a lattice of spacing 1, within [-1, 1], mean 0. Its energy lies around one period per
/// two lattice steps and fades quickly above one period per step, which is what makes the road band-limited.
double gradient_noise(double x, double y, std::uint32_t seed);

/// The same in space, within [-1.5, 1.5]; at z = 0 it is gradient_noise(x, y, seed).
double gradient_noise(double x, double y, double z, std::uint32_t seed);

/// Standard deviation of the planar gradient noise.
inline constexpr double gradient_noise_deviation = 0.1762;

}  // namespace roadstereo::synth
