#include "roadstereo/road_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.hpp"
#include "road/plane_fit.hpp"
#include "road/roll_energy.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Points that the robust solver and the standard error look at: enough for both, few enough to cost nothing.
constexpr std::size_t sample_limit = 6000;

/// Residuals of neighbours are not independent: the standard error takes cells of the map as one observation each.
constexpr int cells_per_side = 24;

using Mask = std::optional<ImageView<const std::uint8_t>>;

bool usable(ImageView<const float> disparity, const Mask& mask, int u, int v) {
  return !std::isnan(disparity(u, v)) && (!mask || (*mask)(u, v) != 0);
}

/// The sums over all usable pixels; added up row by row, so that they do not depend on the number of threads.
PlaneSums sum_map(ImageView<const float> disparity, const Mask& mask, int threads) {
  const PlaneSums origin((disparity.width() - 1) / 2.0, (disparity.height() - 1) / 2.0);
  auto rows = scratch_vector<PlaneSums>(static_cast<std::size_t>(disparity.height()), origin);
  parallel_rows(disparity.height(), 16, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      PlaneSums& row = rows[static_cast<std::size_t>(v)];
      for (int u = 0; u < disparity.width(); ++u) {
        if (usable(disparity, mask, u, v)) row.add({static_cast<double>(u), static_cast<double>(v), disparity(u, v)});
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

/// Valid disparities on a regular grid, at most about `sample_limit`.
ScratchVector<DisparityPoint> sample_map(ImageView<const float> disparity, const Mask& mask) {
  const double per_sample = static_cast<double>(disparity.pixels()) / static_cast<double>(sample_limit);
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(per_sample))));
  auto points = scratch_vector<DisparityPoint>();
  points.reserve(2 * sample_limit);
  for (int v = step / 2; v < disparity.height(); v += step) {
    for (int u = step / 2; u < disparity.width(); u += step) {
      if (usable(disparity, mask, u, v)) {
        points.push_back({static_cast<double>(u), static_cast<double>(v), disparity(u, v)});
      }
    }
  }
  return points;
}

/// Covariance of the slopes (a1, a2) of a weighted plane fit.
struct SlopeCovariance {
  double a1_a1 = 0, a1_a2 = 0, a2_a2 = 0;
};

/// Cluster-robust ("sandwich") covariance: the scores of all points of one cell are added up before they are squared.
SlopeCovariance slope_covariance(std::span<const DisparityPoint> points, std::span<const double> weights,
                                 const RoadModel& plane, int width, int height) {
  PlaneSums sums(width / 2.0, height / 2.0);
  for (std::size_t i = 0; i < points.size(); ++i) sums.add(points[i], weights.empty() ? 1 : weights[i]);
  struct Score {
    double u = 0, v = 0;
  };
  auto cells = scratch_vector<Score>(static_cast<std::size_t>(cells_per_side) * cells_per_side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DisparityPoint& p = points[i];
    const double residual = (weights.empty() ? 1 : weights[i]) * (p.d - plane.disparity(p.u, p.v));
    const auto column = static_cast<std::size_t>(p.u * cells_per_side / width);
    const auto row = static_cast<std::size_t>(p.v * cells_per_side / height);
    cells[row * cells_per_side + column].u += residual * (p.u - sums.mean_u());
    cells[row * cells_per_side + column].v += residual * (p.v - sums.mean_v());
  }
  double uu = 0, uv = 0, vv = 0;
  for (const Score& cell : cells) {
    uu += cell.u * cell.u;
    uv += cell.u * cell.v;
    vv += cell.v * cell.v;
  }
  // Inverse of the normal matrix on both sides.
  const double determinant = sums.uu() * sums.vv() - sums.uv() * sums.uv();
  const double iuu = sums.vv() / determinant, iuv = -sums.uv() / determinant, ivv = sums.uu() / determinant;
  const double left_uu = iuu * uu + iuv * uv, left_uv = iuu * uv + iuv * vv;
  const double left_vu = iuv * uu + ivv * uv, left_vv = iuv * uv + ivv * vv;
  return {left_vu * iuv + left_vv * ivv, left_vu * iuu + left_vv * iuv, left_uu * iuu + left_uv * iuv};
}

/// Standard error of ψ = atan(−a2 / a1).
double roll_standard_error(const SlopeCovariance& covariance, const RoadModel& plane) {
  const double square = plane.a1 * plane.a1 + plane.a2 * plane.a2;
  if (square == 0) return HUGE_VAL;
  const double by_a1 = plane.a2 / square;
  const double by_a2 = -plane.a1 / square;
  const double variance =
      by_a1 * by_a1 * covariance.a1_a1 + 2 * by_a1 * by_a2 * covariance.a1_a2 + by_a2 * by_a2 * covariance.a2_a2;
  return std::sqrt(std::max(variance, 0.0));
}

/// The start of the robust fit: the model known before matching, or the plane that most of the map agrees with.
RoadModel robust_start(std::span<const DisparityPoint> points, const std::optional<RoadModel>& prior,
                       const RoadModel& least_squares) {
  if (prior) return *prior;
  constexpr double tolerance_px = 1.0;
  return search_plane(points, tolerance_px).value_or(least_squares);
}

double start_scale(std::span<const DisparityPoint> points, const RoadModel& start) {
  auto residuals = scratch_vector<double>();
  residuals.reserve(points.size());
  for (const DisparityPoint& p : points) residuals.push_back(p.d - start.disparity(p.u, p.v));
  return start_scale_of(median_magnitude(residuals));
}

/// Whether the road's disparity changes enough over the map for its direction to mean a roll angle.
bool observable(const RoadGeometry& geometry, int width, int height, const RoadGeometryOptions& options) {
  const double gradient = std::hypot(geometry.plane.a1, geometry.plane.a2);
  return geometry.roll_stderr_rad <= options.max_roll_stderr_rad &&
         gradient * std::min(width, height) >= options.min_gradient_px;
}

}  // namespace

void RoadGeometryOptions::validate() const {
  const auto require = [](bool good, const char* name, double value, const char* rule) {
    if (!good) fail("road_geometry.", name, " is ", value, "; it must be ", rule);
  };
  require(initial_lambda > 0 && initial_lambda <= 1e6, "initial_lambda", initial_lambda, "above 0 and at most 1e6");
  require(roll_threshold_rad >= 1e-12 && roll_threshold_rad <= 0.1, "roll_threshold_rad", roll_threshold_rad,
          "between 1e-12 and 0.1");
  require(max_iterations >= 1 && max_iterations <= 100000, "max_iterations", max_iterations, "between 1 and 100000");
  require(delta_t_px <= 10000, "delta_t_px", delta_t_px, "at most 10000, or negative to derive it");
  require(max_roll_stderr_rad > 0, "max_roll_stderr_rad", max_roll_stderr_rad, "above 0");
  require(min_gradient_px >= 0, "min_gradient_px", min_gradient_px, "at least 0");
}

RoadGeometry fit_road_geometry(ImageView<const float> disparity, const Mask& mask,
                               const std::optional<RoadModel>& prior, double initial_roll_rad,
                               const RoadGeometryOptions& options, int threads) {
  options.validate();
  if (mask && (mask->width() != disparity.width() || mask->height() != disparity.height())) {
    fail("the mask has ", mask->width(), "×", mask->height(), " pixels and the disparity map ", disparity.width(), "×",
         disparity.height(), "; they must be equal");
  }
  constexpr double fewest = 16;
  const bool robust = options.solver == RollSolver::robust;
  const ScratchVector<DisparityPoint> points = sample_map(disparity, mask);
  const PlaneSums sums = robust ? sum_points(points) : sum_map(disparity, mask, threads);
  if (sums.weight() < fewest) {
    fail("only ", sums.weight(), " disparities are valid; the road geometry needs at least ", fewest);
  }
  const std::optional<RoadModel> least_squares = sums.plane();
  if (!least_squares) fail("all valid disparities lie on one line of the image; the road geometry needs an area");

  RoadGeometry geometry;
  geometry.pixels = static_cast<std::size_t>(sums.weight());
  auto weights = scratch_vector<double>();
  if (robust) {
    const RoadModel start = robust_start(points, prior, *least_squares);
    auto fit = fit_robust_plane(points, start, start_scale(points, start), true, options.max_iterations);
    geometry.plane = fit ? fit->plane : *least_squares;
    geometry.iterations = fit ? fit->iterations : 0;
    geometry.roll_rad = roll_of_plane(geometry.plane);
    if (fit) weights = std::move(fit->weights);
  } else {
    const RollEnergy energy(sums);
    RollSolution solution{roll_of_plane(*least_squares), 1};
    if (options.solver == RollSolver::gradient_descent) solution = descend_roll(energy, initial_roll_rad, options);
    geometry.roll_rad = solution.roll;
    geometry.iterations = solution.iterations;
    const double alpha1 = energy.alpha1(solution.roll);
    geometry.plane = {energy.alpha0(solution.roll), alpha1 * std::cos(solution.roll),
                      -alpha1 * std::sin(solution.roll)};
  }
  geometry.alpha0 = geometry.plane.a0;
  geometry.alpha1 = geometry.plane.a1 * std::cos(geometry.roll_rad) - geometry.plane.a2 * std::sin(geometry.roll_rad);
  PlaneSums residuals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DisparityPoint& p = points[i];
    residuals.add({p.u, p.v, p.d - geometry.plane.disparity(p.u, p.v)}, weights.empty() ? 1 : weights[i]);
  }
  geometry.residual_px = std::sqrt(std::max(residuals.dd() / residuals.weight(), 0.0));
  const SlopeCovariance covariance =
      slope_covariance(points, weights, geometry.plane, disparity.width(), disparity.height());
  geometry.roll_stderr_rad = roll_standard_error(covariance, geometry.plane);
  geometry.roll_observable = observable(geometry, disparity.width(), disparity.height(), options);
  return geometry;
}

}  // namespace roadstereo
