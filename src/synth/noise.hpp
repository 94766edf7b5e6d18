#pragma once

#include <cstdint>

namespace roadstereo::synth {

/// Smoothstep: cubic Hermite step from 0 at x ≤ 0 to 1 at x ≥ 1.
template <class Number>
Number smooth_step(Number x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x * x * (3 - 2 * x);
}

/// Perlin gradient noise on a lattice of spacing 1, in [−1, 1], mean 0. Its power is concentrated around a period of
/// two lattice steps and falls off quickly below one step, so that the texture is band-limited.
double gradient_noise(double x, double y, std::uint32_t seed);

/// Perlin gradient noise in three dimensions, in [−1.5, 1.5]. Equals gradient_noise(x, y, seed) at z = 0.
double gradient_noise(double x, double y, double z, std::uint32_t seed);

/// Standard deviation of the two-dimensional noise.
inline constexpr double gradient_noise_sigma = 0.1762;

}  // namespace roadstereo::synth
