#include "roadstereo/roll.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "road/bend.hpp"
#include "road/plane_fit.hpp"
#include "road/roll_assessment.hpp"
#include "road/roll_energy.hpp"

namespace roadstereo {
namespace {

using Region = ImageView<const std::uint8_t>;

bool usable(ImageView<const float> disparity, Region region, int u, int v) {
  return !std::isnan(disparity(u, v)) && (region.empty() || region(u, v) != 0);
}

/// The sums over all usable pixels; added up row by row, so that they do not depend on the number of threads.
PlaneSums sum_map(ImageView<const float> disparity, Region region, int threads) {
  const PlaneSums origin((disparity.width() - 1) / 2.0, (disparity.height() - 1) / 2.0);
  auto rows = scratch_vector<PlaneSums>(static_cast<std::size_t>(disparity.height()), origin);
  parallel_rows(disparity.height(), 16, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      PlaneSums& row = rows[static_cast<std::size_t>(v)];
      for (int u = 0; u < disparity.width(); ++u) {
        if (usable(disparity, region, u, v)) row.add({static_cast<double>(u), static_cast<double>(v), disparity(u, v)});
      }
    }
  });
  PlaneSums total = origin;
  for (const PlaneSums& row : rows) total.add(row);
  return total;
}

PlaneSums sum_points(std::span<const DisparityPoint> points) {
  PlaneSums sums;
  for (const DisparityPoint& p : points) sums.add(p);
  return sums;
}

/// Disparities on a regular grid; NaN where they are not usable.
ScratchVector<DisparityPoint> sample_map(ImageView<const float> disparity, Region region) {
  const MapSample sample = map_sample(disparity.width(), disparity.height());
  auto points = scratch_vector<DisparityPoint>();
  points.reserve(static_cast<std::size_t>(sample.count()));
  for (int row = 0; row < sample.rows; ++row) {
    const int v = sample.at(row);
    for (int column = 0; column < sample.columns; ++column) {
      const int u = sample.at(column);
      points.push_back({static_cast<double>(u), static_cast<double>(v),
                        usable(disparity, region, u, v) ? disparity(u, v) : std::numeric_limits<double>::quiet_NaN()});
    }
  }
  return points;
}

BendFit fit_bend(std::span<const DisparityPoint> points, std::span<const double> weights, const DisparityPlane& plane,
                 const PlaneSums& sums) {
  const LevelDirection level(plane);
  BendSums bend{sums.weight(), sums.uu(), sums.uv(), sums.vv(), 0, 0, 0, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double du = points[i].u - sums.mean_u(), dv = points[i].v - sums.mean_v();
    const double s = level.along(du, dv);
    const double weight = weights.empty() ? 1 : weights[i];
    const double p = weight * s * s;
    const double r = weight * (points[i].d - plane.disparity(points[i].u, points[i].v));
    bend.p += p;
    bend.pu += p * du;
    bend.pv += p * dv;
    bend.pp += p * s * s;
    bend.r += r;
    bend.ru += r * du;
    bend.rv += r * dv;
    bend.rp += r * s * s;
  }
  return BendFit(bend);
}

/// Adds up the scores of all points of a cell before they are squared. Without weights all count as 1.
void sum_scores(std::span<const DisparityPoint> points, std::span<const double> weights, const DisparityPlane& plane,
                int width, int height, FitMoments& moments) {
  PlaneSums sums(width / 2.0, height / 2.0);
  for (std::size_t i = 0; i < points.size(); ++i) sums.add(points[i], weights.empty() ? 1 : weights[i]);
  const LevelDirection level(plane);
  const BendFit bend = fit_bend(points, weights, plane, sums);
  struct Score {
    double u = 0, v = 0, bend = 0;
  };
  auto cells = scratch_vector<Score>(static_cast<std::size_t>(cells_per_side) * cells_per_side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DisparityPoint& p = points[i];
    const double weight = weights.empty() ? 1 : weights[i];
    const double du = p.u - sums.mean_u(), dv = p.v - sums.mean_v();
    const double residual = p.d - plane.disparity(p.u, p.v);
    const double rest = bend.rest(level.along(du, dv), du, dv);
    const auto column = static_cast<std::size_t>(cell_of(p.u, width));
    const auto row = static_cast<std::size_t>(cell_of(p.v, height));
    Score& cell = cells[row * cells_per_side + column];
    cell.u += weight * residual * du;
    cell.v += weight * residual * dv;
    cell.bend += weight * (residual - bend.bend * rest) * rest;
  }
  double bend_scores = 0;
  for (const Score& cell : cells) {
    moments.score_uu += cell.u * cell.u;
    moments.score_uv += cell.u * cell.v;
    moments.score_vv += cell.v * cell.v;
    bend_scores += cell.bend * cell.bend;
  }
  moments.bend = bend.bend;
  moments.bend_variance = bend.normal > 0 ? bend_scores / (bend.normal * bend.normal) : 0;
  moments.uu = sums.uu();
  moments.uv = sums.uv();
  moments.vv = sums.vv();
}

/// Leaves only the points of the sample that can be of the road of which `prior` is an estimate, if any of those by
/// which planes are compared can.
void leave_out_scene(const DisparityPlane& prior, std::span<DisparityPoint> sample) {
  const auto is_of_road = [&](const DisparityPoint& p) { return can_be_of_road(p.d, prior.disparity(p.u, p.v)); };
  const auto count = static_cast<int>(sample.size());
  bool any_of_road = false;
  for (int k = 0; k < compared_points && !any_of_road; ++k) {
    any_of_road = is_of_road(sample[static_cast<std::size_t>(compared_point(k, count))]);
  }
  if (!any_of_road) return;
  for (DisparityPoint& point : sample) {
    if (!is_of_road(point)) point.d = std::numeric_limits<double>::quiet_NaN();
  }
}

FitMoments fit_moments(std::span<const DisparityPoint> points, std::span<const double> weights,
                       const DisparityPlane& plane, int width, int height) {
  FitMoments moments{};
  sum_scores(points, weights, plane, width, height, moments);
  PlaneSums residuals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DisparityPoint& p = points[i];
    residuals.add({p.u, p.v, p.d - plane.disparity(p.u, p.v)}, weights.empty() ? 1 : weights[i]);
  }
  moments.n = residuals.weight();
  moments.residuals = residuals.dd();
  return moments;
}

/// Plane, roll angle and iterations; without a fit the least-squares plane, and no weights. The fit starts from the
/// least quantile of the `sample`, of which `points` are not missing; it is changed.
RollEstimate fit_robustly(std::span<DisparityPoint> sample, std::span<const DisparityPoint> points,
                          const std::optional<DisparityPlane>& prior, int max_iterations,
                          ScratchVector<double>& weights) {
  const PlaneSums sums = sum_points(points);
  require_enough(sums.weight());
  const std::optional<DisparityPlane> least_squares = sums.plane();
  if (!least_squares) fail_on_one_line();
  RollEstimate geometry;
  geometry.pixels = points.size();
  if (prior) leave_out_scene(*prior, sample);
  const QuantilePlane start = least_quantile_plane(sample, prior.value_or(*least_squares));
  auto fit = fit_plane_irls(points, start.plane, start_scale_of(start.quantile_px), true, max_iterations);
  geometry.plane = fit ? fit->plane : *least_squares;
  geometry.iterations = fit ? fit->iterations : 0;
  geometry.roll_rad = roll_of_plane(geometry.plane);
  if (fit) weights = std::move(fit->weights);
  return geometry;
}

}  // namespace

void RollOptions::validate() const {
  require_range("roll", "initial_lambda", initial_lambda, Above{0.0}, 1e6);
  require_range("roll", "roll_threshold_rad", roll_threshold_rad, 1e-12, 0.1);
  require_range("roll", "max_iterations", max_iterations, 1, 100000);
  require_range("roll", "delta_t_px", delta_t_px, -unlimited, 10000.0);
  require_range("roll", "max_roll_stderr_rad", max_roll_stderr_rad, Above{0.0}, unlimited);
  require_range("roll", "min_gradient_px", min_gradient_px, 0.0, unlimited);
}

RollEstimate estimate_roll(ImageView<const float> disparity, Region region, const std::optional<DisparityPlane>& prior,
                           double initial_roll_rad, const RollOptions& options, int threads) {
  options.validate();
  if (!region.empty()) require_same_size("the region", map_size(region), "the disparity map", map_size(disparity));
  ScratchVector<DisparityPoint> sample = sample_map(disparity, region);
  auto points = scratch_vector<DisparityPoint>();
  points.reserve(sample.size());
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(points),
               [](const DisparityPoint& p) { return !std::isnan(p.d); });
  auto weights = scratch_vector<double>();
  RollEstimate geometry = options.solver == RollSolver::robust
                              ? fit_robustly(sample, points, prior, options.max_iterations, weights)
                              : solve_from_sums(sum_map(disparity, region, threads), initial_roll_rad, options);
  const FitMoments moments = fit_moments(points, weights, geometry.plane, disparity.width(), disparity.height());
  assess_roll(moments, disparity.width(), disparity.height(), options, geometry);
  return geometry;
}

}  // namespace roadstereo
