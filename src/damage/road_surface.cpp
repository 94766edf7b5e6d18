#include "damage/road_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/cholesky.hpp"
#include "core/median.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t plane_terms = 3;
constexpr std::size_t quadratic_terms = 6;
using Terms = Vector<quadratic_terms>;
using Values = std::vector<double>;

/// Cells that may be road, one element each. `residual` is the value less the fit so far.
struct Samples {
  Values x, y, scale, value, residual;

  explicit Samples(std::size_t count) : x(count), y(count), scale(count), value(count), residual(count) {}
  std::size_t size() const { return value.size(); }
  void resize(std::size_t count) {
    for (Values* values : {&x, &y, &scale, &value, &residual}) values->resize(count);
  }
};

/// A regular sample of the cells that may be road. Residuals are against `earlier` where it is given.
Samples draw_samples(const Cells& cells, const SurfaceCoordinates& coordinates, const Image<std::uint8_t>* region,
                     const RoadSurface* earlier, Sampling sampling) {
  constexpr std::size_t least_samples = 32;
  const int most_samples = sampling == Sampling::rough ? 1'500 : 6'000;
  const double share = static_cast<double>(cells.value.pixels()) / most_samples;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(share))));
  const int most_columns = cells.width() / step + 1, most_rows = cells.height() / step + 1;
  Samples samples(static_cast<std::size_t>(most_columns) * static_cast<std::size_t>(most_rows));
  std::size_t count = 0;
  for (int j = step / 2; j < cells.height(); j += step) {
    for (int i = step / 2; i < cells.width(); i += step) {
      if (std::isnan(cells.value(i, j)) || std::isnan(coordinates.x(i, j))) continue;
      if (region != nullptr && (*region)(i, j) == 0) continue;
      samples.x[count] = coordinates.x(i, j);
      samples.y[count] = coordinates.y(i, j);
      samples.scale[count] = coordinates.scale(i, j);
      samples.value[count] = cells.value(i, j);
      samples.residual[count] = earlier != nullptr ? samples.value[count] - earlier->value(i, j) : 0;
      ++count;
    }
  }
  if (count < least_samples) {
    if (sampling == Sampling::rough) return draw_samples(cells, coordinates, region, earlier, Sampling::fine);
    fail("the transformed map has ", count, " valid places on the road; at least ", least_samples, " are needed");
  }
  samples.resize(count - count % 2);  // they are added up in twos
  return samples;
}

/// Middle and half-width of the shortest interval that holds a third of the values: the road, whatever else is seen.
struct Shorth {
  double middle = 0;
  double half_width = 0;
};

Shorth shorth_of(Values values) {
  std::sort(values.begin(), values.end());
  const std::size_t held = values.size() / 3;
  std::size_t best = 0;
  for (std::size_t i = 0; i + held < values.size(); ++i) {
    if (values[i + held] - values[i] < values[best + held] - values[best]) best = i;
  }
  return {0.5 * (values[best] + values[best + held]), 0.5 * (values[best + held] - values[best])};
}

/// Robust standard deviation of the residuals that are not far out.
double spread_of(const Values& residuals, double reach) {
  std::vector<float> sizes;
  sizes.reserve(residuals.size());
  for (const double residual : residuals) {
    if (std::abs(residual) <= reach) sizes.push_back(static_cast<float>(std::abs(residual)));
  }
  return sizes.empty() ? 0 : gaussian_mad * static_cast<double>(take_median(sizes));
}

/// The normal equations of a weighted fit.
struct Equations {
  Matrix<quadratic_terms> normal{};
  Terms right{};
};

/// The first `terms` terms of the fit; the others are 0, and so are those that the samples do not tell apart from the
/// ones before.
template <std::size_t terms>
Terms solve(const Equations& equations) {
  constexpr double smallest = 1e-13;  // some rounding errors
  Matrix<terms> factor{};
  Vector<terms> right{};
  for (std::size_t i = 0; i < terms; ++i) {
    right[i] = equations.right[i];
    for (std::size_t j = 0; j <= i; ++j) factor[i][j] = equations.normal[i][j];
  }
  factor_in_place(factor, smallest);
  const Vector<terms> solved = solve_factored(factor, right);
  Terms solution{};
  std::copy(solved.begin(), solved.end(), solution.begin());
  return solution;
}

/// Two samples side by side.
struct Two {
  double first = 0, second = 0;

  double sum() const { return first + second; }
  Two& operator+=(Two other) { return *this = {first + other.first, second + other.second}; }
};
Two operator*(Two a, Two b) {
  return {a.first * b.first, a.second * b.second};
}

/// Roots of Tukey's weights of residuals that are given as shares of the reach.
Two roots_of_weights(Two shares) {
  const Two squares = shares * shares;
  return {std::max(0.0, 1 - squares.first), std::max(0.0, 1 - squares.second)};
}

/// Sums over the samples with Tukey's weights. The terms are scale · (1, x, y, x², xy, y²), so that the normal matrix
/// holds no more than the sums of weight · scale² · x^a·y^b for a + b ≤ 4.
Equations add_up(const Samples& samples, double reach) {
  constexpr std::size_t powers = 15;
  std::array<Two, powers> left{};
  std::array<Two, quadratic_terms> right{};
  const Two per_reach{1 / reach, 1 / reach};
  for (std::size_t k = 0; k < samples.size(); k += 2) {
    const auto two = [k](const Values& values) { return Two{values[k], values[k + 1]}; };
    const Two x = two(samples.x), y = two(samples.y), scale = two(samples.scale);
    const Two root = roots_of_weights(two(samples.residual) * per_reach);
    const Two once = root * root * scale, twice = once * scale, seen = once * two(samples.value);
    const Two xx = x * x, xy = x * y, yy = y * y;
    const std::array<Two, quadratic_terms> basis{Two{1, 1}, x, y, xx, xy, yy};
    for (std::size_t i = 0; i < basis.size(); ++i) {
      left[i] += twice * basis[i];
      right[i] += seen * basis[i];
    }
    const Two cube = twice * xx, mixed = twice * xy, other = twice * yy;
    const std::array<Two, powers - quadratic_terms> higher{cube * x,  cube * y,  other * x,  other * y, cube * xx,
                                                           cube * xy, cube * yy, mixed * yy, other * yy};
    for (std::size_t i = 0; i < higher.size(); ++i) left[quadratic_terms + i] += higher[i];
  }
  // Which power of x and y is the product of two terms.
  constexpr std::array<std::array<std::size_t, quadratic_terms>, quadratic_terms> product{{{0, 1, 2, 3, 4, 5},
                                                                                           {1, 3, 4, 6, 7, 8},
                                                                                           {2, 4, 5, 7, 8, 9},
                                                                                           {3, 6, 7, 10, 11, 12},
                                                                                           {4, 7, 8, 11, 12, 13},
                                                                                           {5, 8, 9, 12, 13, 14}}};
  Equations equations;
  for (std::size_t i = 0; i < quadratic_terms; ++i) {
    equations.right[i] = right[i].sum();
    for (std::size_t j = 0; j < quadratic_terms; ++j) equations.normal[i][j] = left[product[i][j]].sum();
  }
  return equations;
}

/// What a solution gives at a place of the road.
double quadratic(const Terms& c, double x, double y, double scale) {
  return scale * (c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y));
}

/// Steps of the reweighted fit with the first `terms` terms; `spread` and the residuals are brought up to date.
template <std::size_t terms>
Terms iterate(Samples& samples, int steps, double& spread) {
  constexpr double tukey = 4.7;
  constexpr double widest = 3;  // of the spread, for what counts when it is measured anew
  Terms solution{};
  for (int i = 0; i < steps; ++i) {
    solution = solve<terms>(add_up(samples, tukey * spread));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples.residual[k] = samples.value[k] - quadratic(solution, samples.x[k], samples.y[k], samples.scale[k]);
    }
    const double measured = spread_of(samples.residual, widest * spread);
    spread = std::max(measured, 0.5 * spread);
    if (measured == 0) break;
  }
  return solution;
}

RoadSurface evaluate(const Terms& solution, double noise, const Cells& cells, const SurfaceCoordinates& coordinates) {
  RoadSurface surface;
  surface.noise = noise;
  surface.value.resize(cells.width(), cells.height());
  for (int j = 0; j < cells.height(); ++j) {
    const float *x = coordinates.x.row(j), *y = coordinates.y.row(j), *scale = coordinates.scale.row(j);
    float* value = surface.value.row(j);
    for (int i = 0; i < cells.width(); ++i) {
      value[i] = static_cast<float>(quadratic(solution, double{x[i]}, double{y[i]}, double{scale[i]}));
    }
  }
  return surface;
}

}  // namespace

RoadSurface fit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates) {
  constexpr int plane_steps = 6;
  constexpr int quadratic_steps = 8;
  constexpr double least_spread = 1e-3;
  Samples samples = draw_samples(cells, coordinates, nullptr, nullptr, Sampling::rough);
  const Shorth start = shorth_of(samples.value);
  for (std::size_t k = 0; k < samples.size(); ++k) samples.residual[k] = samples.value[k] - start.middle;
  double spread = std::max({start.half_width, least_spread * std::abs(start.middle), 1e-9});
  iterate<plane_terms>(samples, plane_steps, spread);
  const Terms solution = iterate<quadratic_terms>(samples, quadratic_steps, spread);
  return evaluate(solution, spread, cells, coordinates);
}

RoadSurface refit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                               const Image<std::uint8_t>& region, const RoadSurface& earlier, Sampling sampling) {
  constexpr int steps = 6;
  Samples samples = draw_samples(cells, coordinates, &region, &earlier, sampling);
  double spread = std::max(earlier.noise, 1e-9);
  const Terms solution = iterate<quadratic_terms>(samples, steps, spread);
  return evaluate(solution, spread, cells, coordinates);
}

}  // namespace roadstereo
