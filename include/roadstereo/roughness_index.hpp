#pragma once

#include <array>
#include <cstddef>
#include <span>

#pragma GCC visibility push(default)
namespace roadstereo {

// International Roughness Index (ASTM E1926, World Bank Technical Paper 46): mean suspension motion of the golden
// quarter car at 80 km/h, per distance.

/// Exact step of the golden car over a constant slope: state ← transition · state + input · slope. The state is
/// (sprung, its rate, unsprung, its rate), all divided by the distance unit of the slope.
struct GoldenCarStep {
  std::array<std::array<double, 4>, 4> transition{};
  std::array<double, 4> input{};
};
/// Returns the step of a spacing, metres: matrix exponential of dt = spacing / (80 km/h).
GoldenCarStep golden_car_step(double spacing_m);

/// Returns the smallest number of heights at a spacing, metres, that has an index.
std::size_t min_roughness_samples(double spacing_m);

/// Returns the index of a profile, m/km: slopes over 250 mm drive the car, which starts with the mean slope of the
/// first 11 m. `heights` in metres at equal spacing, at least 11 m long. Throws Error for shorter profiles, for a
/// spacing outside 0.01 … 0.5 m, and for heights that are not finite.
double roughness_index(std::span<const double> heights_m, double spacing_m);

/// Returns the index of a flat road whose heights have independent errors of this standard deviation, m/km: √(2/π)
/// times the root of the summed squares of the impulse response.
double roughness_noise_floor(double std_error_m, double spacing_m);

}  // namespace roadstereo
#pragma GCC visibility pop
