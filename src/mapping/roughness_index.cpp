#include "roadstereo/roughness_index.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/require_range.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr double speed_m_s = 80 / 3.6;
constexpr double metres_per_kilometre = 1000;
constexpr double smoothing_m = 0.25;  ///< length of the tyre's contact
constexpr double start_m = 11;        ///< whose mean slope the car starts with

/// State and slope; the slope is constant.
using Augmented = std::array<std::array<double, 5>, 5>;

Augmented multiply(const Augmented& a, const Augmented& b) {
  Augmented product{};
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      for (std::size_t j = 0; j < a.size(); ++j) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

/// Matrix exponential by scaling and squaring of the Taylor series.
Augmented exponential(Augmented a) {
  constexpr int squarings = 10, terms = 8;
  for (auto& row : a) {
    for (double& element : row) element = std::ldexp(element, -squarings);
  }
  Augmented sum{}, term{};
  for (std::size_t i = 0; i < a.size(); ++i) sum[i][i] = term[i][i] = 1;
  for (int k = 1; k <= terms; ++k) {
    term = multiply(term, a);
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < a.size(); ++j) {
        term[i][j] /= k;
        sum[i][j] += term[i][j];
      }
    }
  }
  for (int k = 0; k < squarings; ++k) sum = multiply(sum, sum);
  return sum;
}

/// The car on its way.
class GoldenCar {
 public:
  GoldenCar(double spacing_m, double start_slope) : step_(golden_car_step(spacing_m)) {
    state_ = {start_slope, 0, start_slope, 0};
  }

  /// Drives one spacing; returns the suspension's motion per distance.
  double drive(double slope) {
    std::array<double, 4> next{};
    for (std::size_t i = 0; i < 4; ++i) {
      next[i] = step_.input[i] * slope;
      for (std::size_t k = 0; k < 4; ++k) next[i] += step_.transition[i][k] * state_[k];
    }
    state_ = next;
    return state_[0] - state_[2];
  }

 private:
  GoldenCarStep step_;
  std::array<double, 4> state_{};
};

std::size_t smoothing_steps(double spacing_m) {
  return static_cast<std::size_t>(std::max(1L, std::lround(smoothing_m / spacing_m)));
}

/// Heights of the way over which the first slope is averaged.
std::size_t start_samples(double spacing_m) {
  return static_cast<std::size_t>(std::lround(start_m / spacing_m));
}

}  // namespace

GoldenCarStep golden_car_step(double spacing_m) {
  constexpr double tyre = 653, spring = 63.3, mass = 0.15, damper = 6;  // K_t/M_s, K_s/M_s, M_u/M_s, C_s/M_s
  Augmented a{};
  a[0] = {0, 1, 0, 0, 0};
  a[1] = {-spring, -damper, spring, damper, 0};
  a[2] = {0, 0, 0, 1, 0};
  a[3] = {spring / mass, damper / mass, -(tyre + spring) / mass, -damper / mass, tyre / mass};
  for (auto& row : a) {
    for (double& element : row) element *= spacing_m / speed_m_s;
  }
  const Augmented whole = exponential(a);
  GoldenCarStep step;
  for (std::size_t i = 0; i < 4; ++i) {
    std::copy_n(whole[i].begin(), 4, step.transition[i].begin());
    step.input[i] = whole[i][4];
  }
  return step;
}

std::size_t min_roughness_samples(double spacing_m) {
  return start_samples(spacing_m) + smoothing_steps(spacing_m) + 1;
}

double roughness_index(std::span<const double> heights_m, double spacing_m) {
  require_range("profile", "spacing_m", spacing_m, 0.01, 0.5);
  const std::size_t k = smoothing_steps(spacing_m), start = start_samples(spacing_m);
  if (heights_m.size() < min_roughness_samples(spacing_m)) {
    fail("the profile is ", static_cast<double>(heights_m.size()) * spacing_m, " m long; its index needs more than ",
         start_m, " m");
  }
  if (!std::all_of(heights_m.begin(), heights_m.end(), [](double height) { return std::isfinite(height); })) {
    fail("the profile has gaps; its index needs every height");
  }
  GoldenCar car(spacing_m, (heights_m[start] - heights_m[0]) / (static_cast<double>(start) * spacing_m));
  double sum = 0;
  for (std::size_t i = 0; i + k < heights_m.size(); ++i) {
    sum += std::abs(car.drive((heights_m[i + k] - heights_m[i]) / (static_cast<double>(k) * spacing_m)));
  }
  return metres_per_kilometre * sum / static_cast<double>(heights_m.size() - k);
}

double roughness_noise_floor(double std_error_m, double spacing_m) {
  require_range("profile", "spacing_m", spacing_m, 0.01, 0.5);
  constexpr double memory_m = 60;  // of the car; its slowest mode decays with 1/e in some 7 m
  const auto k = static_cast<std::ptrdiff_t>(smoothing_steps(spacing_m));
  const auto steps = static_cast<std::ptrdiff_t>(memory_m / spacing_m);
  GoldenCar car(spacing_m, 0);
  double squares = 0;
  for (std::ptrdiff_t i = -k; i < steps; ++i) {  // a height of 1 m at position 0
    const double slope = (i == -k ? 1.0 : i == 0 ? -1.0 : 0.0) / (static_cast<double>(k) * spacing_m);
    const double motion = car.drive(slope);
    squares += motion * motion;
  }
  return metres_per_kilometre * std_error_m * std::sqrt(2 / std::numbers::pi * squares);
}

}  // namespace roadstereo
