#include "damage/road_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/binned_selection.hpp"
#include "core/cholesky.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/tukey.hpp"
#include "damage/road_undulation.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Terms of the surface, in the order 1, x, y, x², xy, y²; a plane has the first three.
constexpr std::size_t plane_term_count = 3;
constexpr std::size_t quadratic_term_count = 6;
using Coefficients = Vector<quadratic_term_count>;
using Values = std::vector<double>;

/// Sampled cells, structure of arrays. `residual` is the value minus the current fit.
struct Samples {
  Values x, y, scale, value, residual;

  explicit Samples(std::size_t count) : x(count), y(count), scale(count), value(count), residual(count) {}
  std::size_t size() const { return value.size(); }
  void resize(std::size_t count) {
    for (Values* values : {&x, &y, &scale, &value, &residual}) values->resize(count);
  }
};

/// Take a regular sample of the valid cells, inside `region` if it is given. Residuals are relative to `earlier` if it
/// is given. A coarse sample of too few cells is replaced by a fine one. The size is even (see `accumulate`).
Samples sample_cells(const Cells& cells, const SurfaceCoordinates& coordinates, const Image<std::uint8_t>* region,
                     const RoadSurface* earlier, Sampling sampling) {
  constexpr std::size_t min_samples = 32;
  const int max_samples = sampling == Sampling::coarse ? 1'500 : 6'000;
  const double cells_per_sample = static_cast<double>(cells.value.pixels()) / max_samples;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(cells_per_sample))));
  const int max_columns = cells.width() / step + 1, max_rows = cells.height() / step + 1;
  Samples samples(static_cast<std::size_t>(max_columns) * static_cast<std::size_t>(max_rows));
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
  if (count < min_samples) {
    if (sampling == Sampling::coarse) return sample_cells(cells, coordinates, region, earlier, Sampling::fine);
    fail("the transformed map has ", count, " valid samples on the road; it must have at least ", min_samples);
  }
  samples.resize(count - count % 2);
  return samples;
}

/// Shortest interval that contains a third of the values: a robust start, since the other values may be outliers.
struct Shorth {
  double middle = 0;
  double half_width = 0;
};

Shorth shorth_of(Values values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size() / 3;
  std::size_t best = 0;
  for (std::size_t i = 0; i + count < values.size(); ++i) {
    if (values[i + count] - values[i] < values[best + count] - values[best]) best = i;
  }
  return {0.5 * (values[best] + values[best + count]), 0.5 * (values[best + count] - values[best])};
}

/// Normal equations of a weighted fit.
struct NormalEquations {
  Matrix<quadratic_term_count> matrix{};
  Coefficients right{};
};

/// Solve for the first `count` terms; the others are 0. Terms that depend linearly on earlier ones are 0, too.
template <std::size_t count>
Coefficients solve(const NormalEquations& equations) {
  constexpr double rank_tolerance = 1e-13;  // relative to the diagonal: some hundred rounding errors
  Matrix<count> factor{};
  Vector<count> right{};
  for (std::size_t i = 0; i < count; ++i) {
    right[i] = equations.right[i];
    for (std::size_t j = 0; j <= i; ++j) factor[i][j] = equations.matrix[i][j];
  }
  factor_in_place(factor, rank_tolerance);
  const Vector<count> solved = solve_factored(factor, right);
  Coefficients solution{};
  std::copy(solved.begin(), solved.end(), solution.begin());
  return solution;
}

/// Two samples that are processed together, as vectors of two doubles.
struct SamplePair {
  double first = 0, second = 0;

  double sum() const { return first + second; }
  SamplePair& operator+=(SamplePair other) { return *this = {first + other.first, second + other.second}; }
};
SamplePair operator*(SamplePair a, SamplePair b) {
  return {a.first * b.first, a.second * b.second};
}

/// Square roots of the Tukey weights (1 − r²)² of residuals r, given relative to the truncation.
SamplePair roots_of_weights(SamplePair residuals) {
  const SamplePair squares = residuals * residuals;
  return {std::max(0.0, 1 - squares.first), std::max(0.0, 1 - squares.second)};
}

/// Accumulate the normal equations with Tukey weights truncated at `max_residual`. The plain loop is
///
///     for each sample:
///       w = tukey_weight(residual / max_residual)
///       t = scale · (1, x, y, x², xy, y²)
///       matrix += w · t · tᵀ
///       right  += w · t · value
///
/// The 36 elements of t·tᵀ are scale² times only 15 different monomials x^a·y^b, a + b ≤ 4, so their moments are
/// accumulated instead, for two samples at a time, and the matrix is assembled at the end. Moments 0 … 5 belong to the
/// terms, 6 … 14 to x³, x²y, xy², y³, x⁴, x³y, x²y², xy³, y⁴.
/// Of the first three terms only, the moments from 6 on are not needed.
template <std::size_t count>
NormalEquations accumulate(const Samples& samples, double max_residual) {
  constexpr std::size_t moment_count = 15;
  std::array<SamplePair, moment_count> moments{};
  std::array<SamplePair, quadratic_term_count> right{};
  const SamplePair inverse_max{1 / max_residual, 1 / max_residual};
  for (std::size_t k = 0; k < samples.size(); k += 2) {
    const auto pair = [k](const Values& values) { return SamplePair{values[k], values[k + 1]}; };
    const SamplePair x = pair(samples.x), y = pair(samples.y), scale = pair(samples.scale);
    const SamplePair root = roots_of_weights(pair(samples.residual) * inverse_max);
    const SamplePair ws = root * root * scale, wss = ws * scale, wsv = ws * pair(samples.value);
    const SamplePair xx = x * x, xy = x * y, yy = y * y;
    const std::array<SamplePair, quadratic_term_count> basis{SamplePair{1, 1}, x, y, xx, xy, yy};
    for (std::size_t i = 0; i < basis.size(); ++i) {
      moments[i] += wss * basis[i];
      right[i] += wsv * basis[i];
    }
    if constexpr (count == plane_term_count) continue;
    const SamplePair wxx = wss * xx, wxy = wss * xy, wyy = wss * yy;
    const std::array<SamplePair, moment_count - quadratic_term_count> higher{
        wxx * x, wxx * y, wyy * x, wyy * y, wxx * xx, wxx * xy, wxx * yy, wxy * yy, wyy * yy};
    for (std::size_t i = 0; i < higher.size(); ++i) moments[quadratic_term_count + i] += higher[i];
  }
  // Moment of the product of two terms.
  constexpr std::array<std::array<std::size_t, quadratic_term_count>, quadratic_term_count> moment_of{
      {{0, 1, 2, 3, 4, 5},
       {1, 3, 4, 6, 7, 8},
       {2, 4, 5, 7, 8, 9},
       {3, 6, 7, 10, 11, 12},
       {4, 7, 8, 11, 12, 13},
       {5, 8, 9, 12, 13, 14}}};
  NormalEquations equations;
  for (std::size_t i = 0; i < quadratic_term_count; ++i) {
    equations.right[i] = right[i].sum();
    for (std::size_t j = 0; j < quadratic_term_count; ++j) equations.matrix[i][j] = moments[moment_of[i][j]].sum();
  }
  return equations;
}

/// ℓ' of the surface at (x, y).
double quadratic(const Coefficients& c, double x, double y, double scale) {
  return scale * (c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y));
}

/// Estimate the standard deviation of the residuals from the MAD of those within three of the last ones; it at most
/// halves. False when it is 0.
bool update_sigma(const Samples& samples, double& sigma) {
  constexpr double max_sigmas = 3;
  const double max_residual = max_sigmas * sigma;
  std::vector<float> magnitudes(samples.size());
  BinnedSelection selection;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double magnitude = std::abs(samples.residual[k]);
    magnitudes[k] = static_cast<float>(magnitude <= max_residual ? magnitude : HUGE_VAL);
  }
  const std::size_t inliers = selection.bin(magnitudes, 0, static_cast<float>(max_residual));
  const double estimate = inliers > 0 ? gaussian_mad * double{selection.select(inliers / 2)} : 0;
  sigma = std::max(estimate, 0.5 * sigma);
  return estimate > 0;
}

/// Iteratively reweighted least squares (IRLS) with the first `count` terms. Updates the residuals and their standard
/// deviation `sigma`, from the MAD, which at most halves in one iteration.
template <std::size_t count>
Coefficients fit_irls(Samples& samples, int iterations, double& sigma) {
  Coefficients solution{};
  for (int i = 0; i < iterations; ++i) {
    solution = solve<count>(accumulate<count>(samples, tukey * sigma));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples.residual[k] = samples.value[k] - quadratic(solution, samples.x[k], samples.y[k], samples.scale[k]);
    }
    if (!update_sigma(samples, sigma)) break;
  }
  return solution;
}

/// Fit the undulation of the road to the residuals of its quadratic, by IRLS. Updates the residuals and `sigma`
/// likewise.
RoadUndulation fit_undulation(Samples& samples, int iterations, double& sigma) {
  RoadUndulation undulation(samples.x, samples.y);
  if (undulation.empty()) return undulation;
  const Values deviation = samples.residual;
  Values weight(samples.size());
  for (int i = 0; i < iterations; ++i) {
    const double inverse_max = 1 / (tukey * sigma), inverse_variance = 1 / (sigma * sigma);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      weight[k] = inverse_variance * tukey_weight(samples.residual[k] * inverse_max);
    }
    undulation.fit(samples.scale, deviation, weight);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      samples.residual[k] = deviation[k] - samples.scale[k] * undulation.height(k);
    }
    if (!update_sigma(samples, sigma)) break;
  }
  return undulation;
}

/// Evaluate the surface at every cell.
RoadSurface evaluate(const Coefficients& solution, const RoadUndulation& undulation, double noise, const Cells& cells,
                     const SurfaceCoordinates& coordinates, int threads) {
  constexpr int rows_per_band = 32;
  RoadSurface surface;
  surface.noise = noise;
  surface.value.resize(cells.width(), cells.height());
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const float *x = coordinates.x.row(j), *y = coordinates.y.row(j), *scale = coordinates.scale.row(j);
      float* value = surface.value.row(j);
      for (int i = 0; i < cells.width(); ++i) {
        value[i] = static_cast<float>(quadratic(solution, double{x[i]}, double{y[i]}, double{scale[i]}));
      }
      if (!undulation.empty()) undulation.add_to(x, y, scale, cells.width(), value);
    }
  });
  return surface;
}

}  // namespace

RoadSurface fit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates, int threads) {
  constexpr int plane_iterations = 6;
  constexpr int quadratic_iterations = 8;
  constexpr double min_relative_sigma = 1e-3;
  Samples samples = sample_cells(cells, coordinates, nullptr, nullptr, Sampling::coarse);
  const Shorth start = shorth_of(samples.value);
  for (std::size_t k = 0; k < samples.size(); ++k) samples.residual[k] = samples.value[k] - start.middle;
  double sigma = std::max({start.half_width, min_relative_sigma * std::abs(start.middle), 1e-9});
  fit_irls<plane_term_count>(samples, plane_iterations, sigma);
  const Coefficients solution = fit_irls<quadratic_term_count>(samples, quadratic_iterations, sigma);
  return evaluate(solution, RoadUndulation(), sigma, cells, coordinates, threads);
}

RoadSurface refit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                               const Image<std::uint8_t>& region, const RoadSurface& earlier, Sampling sampling,
                               int threads) {
  constexpr int iterations = 6;
  Samples samples = sample_cells(cells, coordinates, &region, &earlier, sampling);
  double sigma = std::max(earlier.noise, 1e-9);
  const Coefficients solution = fit_irls<quadratic_term_count>(samples, iterations, sigma);
  const bool undulates = coordinates.is_metric && sampling == Sampling::fine;
  const RoadUndulation undulation = undulates ? fit_undulation(samples, iterations, sigma) : RoadUndulation();
  return evaluate(solution, undulation, sigma, cells, coordinates, threads);
}

}  // namespace roadstereo
