#include "damage/road_surface.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/median.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int plane_terms = 3;
constexpr int quadratic_terms = 6;
using Terms = Eigen::Matrix<double, quadratic_terms, 1>;
using Normal = Eigen::Matrix<double, quadratic_terms, quadratic_terms>;

struct Sample {
  Terms terms;
  double value = 0;
  double residual = 0;
};

Terms terms_at(const SurfaceCoordinates& c, int i, int j) {
  const double x = c.x(i, j);
  const double y = c.y(i, j);
  Terms terms;
  terms << 1, x, y, x * x, x * y, y * y;
  return terms * static_cast<double>(c.scale(i, j));
}

/// A regular sample of the cells that may be road. Residuals are against `earlier` where it is given.
std::vector<Sample> draw_samples(const Cells& cells, const SurfaceCoordinates& coordinates,
                                 const Image<std::uint8_t>* region, const RoadSurface* earlier) {
  constexpr std::size_t least_samples = 32;
  constexpr int most_samples = 6'000;
  const double share = static_cast<double>(cells.value.pixels()) / most_samples;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(share))));
  std::vector<Sample> samples;
  samples.reserve(most_samples);
  for (int j = step / 2; j < cells.height(); j += step) {
    for (int i = step / 2; i < cells.width(); i += step) {
      if (std::isnan(cells.value(i, j)) || std::isnan(coordinates.x(i, j))) continue;
      if (region != nullptr && (*region)(i, j) == 0) continue;
      const double value = cells.value(i, j);
      samples.push_back({terms_at(coordinates, i, j), value, earlier != nullptr ? value - earlier->value(i, j) : 0});
    }
  }
  if (samples.size() < least_samples) {
    fail("the transformed map has ", samples.size(), " valid places on the road; at least ", least_samples,
         " are needed");
  }
  return samples;
}

/// Middle and half-width of the shortest interval that holds a third of the values: the road, whatever else is seen.
struct Shorth {
  double middle = 0;
  double half_width = 0;
};

Shorth shorth_of(const std::vector<Sample>& samples) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const Sample& sample : samples) values.push_back(sample.value);
  std::sort(values.begin(), values.end());
  const std::size_t held = values.size() / 3;
  std::size_t best = 0;
  for (std::size_t i = 0; i + held < values.size(); ++i) {
    if (values[i + held] - values[i] < values[best + held] - values[best]) best = i;
  }
  return {0.5 * (values[best] + values[best + held]), 0.5 * (values[best + held] - values[best])};
}

/// Robust standard deviation of the residuals that are not far out.
double spread_of(const std::vector<Sample>& samples, double reach) {
  std::vector<double> sizes;
  sizes.reserve(samples.size());
  for (const Sample& sample : samples) {
    if (std::abs(sample.residual) <= reach) sizes.push_back(std::abs(sample.residual));
  }
  return sizes.empty() ? 0 : gaussian_mad * take_median(sizes);
}

/// One step of the reweighted fit with the first `terms` terms; residuals are brought up to date.
Terms reweighted_fit(std::vector<Sample>& samples, int terms, double reach) {
  Normal normal = Normal::Zero();
  Terms right = Terms::Zero();
  for (const Sample& sample : samples) {
    const double r = sample.residual / reach;
    if (std::abs(r) >= 1) continue;
    const double weight = (1 - r * r) * (1 - r * r);
    normal.noalias() += weight * sample.terms * sample.terms.transpose();
    right.noalias() += weight * sample.value * sample.terms;
  }
  Terms solution = Terms::Zero();
  solution.head(terms) = normal.topLeftCorner(terms, terms).ldlt().solve(right.head(terms));
  for (Sample& sample : samples) sample.residual = sample.value - solution.dot(sample.terms);
  return solution;
}

/// Steps of the fit with the first `terms` terms; `spread` is brought up to date.
Terms iterate(std::vector<Sample>& samples, int terms, int steps, double& spread) {
  constexpr double tukey = 4.7;
  constexpr double widest = 3;  // of the spread, for what counts when it is measured anew
  Terms solution = Terms::Zero();
  for (int i = 0; i < steps; ++i) {
    solution = reweighted_fit(samples, terms, tukey * spread);
    const double measured = spread_of(samples, widest * spread);
    spread = std::max(measured, 0.5 * spread);
    if (measured == 0) break;
  }
  return solution;
}

RoadSurface evaluate(const Terms& solution, double noise, const Cells& cells, const SurfaceCoordinates& coordinates) {
  RoadSurface surface;
  surface.noise = noise;
  surface.value.assign(cells.width(), cells.height(), std::numeric_limits<float>::quiet_NaN());
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      if (std::isnan(coordinates.x(i, j))) continue;
      surface.value(i, j) = static_cast<float>(solution.dot(terms_at(coordinates, i, j)));
    }
  }
  return surface;
}

}  // namespace

RoadSurface fit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates) {
  constexpr int plane_steps = 6;
  constexpr int quadratic_steps = 8;
  constexpr double least_spread = 1e-3;
  std::vector<Sample> samples = draw_samples(cells, coordinates, nullptr, nullptr);
  const Shorth start = shorth_of(samples);
  for (Sample& sample : samples) sample.residual = sample.value - start.middle;
  double spread = std::max({start.half_width, least_spread * std::abs(start.middle), 1e-9});
  iterate(samples, plane_terms, plane_steps, spread);
  const Terms solution = iterate(samples, quadratic_terms, quadratic_steps, spread);
  return evaluate(solution, spread, cells, coordinates);
}

RoadSurface refit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                               const Image<std::uint8_t>& region, const RoadSurface& earlier) {
  constexpr int steps = 6;
  std::vector<Sample> samples = draw_samples(cells, coordinates, &region, &earlier);
  double spread = std::max(earlier.noise, 1e-9);
  const Terms solution = iterate(samples, quadratic_terms, steps, spread);
  return evaluate(solution, spread, cells, coordinates);
}

}  // namespace roadstereo
