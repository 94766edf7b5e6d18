#include "road/roll_assessment.hpp"

#include <algorithm>
#include <cmath>

#include "road/bend.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Covariance of the slopes (a1, a2) of a weighted plane fit.
struct SlopeCovariance {
  double a1_a1 = 0, a1_a2 = 0, a2_a2 = 0;
};

/// Cluster-robust ("sandwich") covariance: the inverse of the normal matrix on both sides of that of the scores.
SlopeCovariance slope_covariance(const FitMoments& m) {
  const double determinant = m.uu * m.vv - m.uv * m.uv;
  const double iuu = m.vv / determinant, iuv = -m.uv / determinant, ivv = m.uu / determinant;
  const double left_uu = iuu * m.score_uu + iuv * m.score_uv, left_uv = iuu * m.score_uv + iuv * m.score_vv;
  const double left_vu = iuv * m.score_uu + ivv * m.score_uv, left_vv = iuv * m.score_uv + ivv * m.score_vv;
  return {left_vu * iuv + left_vv * ivv, left_vu * iuu + left_vv * iuv, left_uu * iuu + left_uv * iuv};
}

/// Variance of the slope along the lines of equal disparity over a road that bends across its direction: at s from the
/// centre of the points its slope is 2·bend·s, and which s has the roll of the road is not known. What three standard
/// errors of the bend explain is noise, which the covariance of the slopes has already.
double bend_slope_variance(const FitMoments& m, const DisparityPlane& plane) {
  const LevelDirection level(plane);
  const double s2 = (level.u * level.u * m.uu + 2 * level.u * level.v * m.uv + level.v * level.v * m.vv) / m.n;
  return 4 * s2 * std::max(0.0, m.bend * m.bend - 9 * m.bend_variance);
}

/// Standard error of ψ = atan(−a2 / a1): that of the slopes, and the bend of the road.
double roll_standard_error(const FitMoments& moments, const DisparityPlane& plane) {
  const SlopeCovariance covariance = slope_covariance(moments);
  const double square = plane.a1 * plane.a1 + plane.a2 * plane.a2;
  if (square == 0) return HUGE_VAL;
  const double by_a1 = plane.a2 / square;
  const double by_a2 = -plane.a1 / square;
  const double variance =
      by_a1 * by_a1 * covariance.a1_a1 + 2 * by_a1 * by_a2 * covariance.a1_a2 + by_a2 * by_a2 * covariance.a2_a2;
  return std::sqrt(std::max(variance, 0.0) + bend_slope_variance(moments, plane) / square);
}

/// Whether the road's disparity changes enough over the map for its direction to mean a roll angle.
bool observable(const RollEstimate& geometry, int width, int height, const RollOptions& options) {
  const double gradient = std::hypot(geometry.plane.a1, geometry.plane.a2);
  return geometry.roll_stderr_rad <= options.max_roll_stderr_rad &&
         gradient * std::min(width, height) >= options.min_gradient_px;
}

}  // namespace

void require_enough(double points) {
  constexpr double fewest = 16;
  if (points < fewest) {
    fail<NoRoadGeometry>("only ", points, " disparities are valid; the road geometry needs at least ", fewest);
  }
}

void fail_on_one_line() {
  fail<NoRoadGeometry>("all valid disparities lie on one line of the image; the road geometry needs an area");
}

RollEstimate solve_from_sums(const PlaneSums& sums, double initial_roll_rad, const RollOptions& options) {
  const DeviationSums deviations = sums.deviations();
  return take_solved(solve_roll(deviations, roll_from_sums(initial_roll_rad, options)), deviations.n);
}

RollFromSums roll_from_sums(double initial_roll_rad, const RollOptions& options) {
  return {options.solver == RollSolver::gradient_descent,
          initial_roll_rad,
          {options.initial_lambda, options.roll_threshold_rad, options.max_iterations}};
}

RollEstimate take_solved(const SolvedRoll& solved, double points) {
  require_enough(points);
  if (solved.found == 0) fail_on_one_line();
  RollEstimate geometry;
  geometry.pixels = static_cast<std::size_t>(points);
  geometry.roll_rad = solved.roll_rad;
  geometry.iterations = solved.iterations;
  geometry.plane = solved.plane;
  return geometry;
}

void assess_roll(const FitMoments& moments, int width, int height, const RollOptions& options, RollEstimate& geometry) {
  geometry.alpha0 = geometry.plane.a0;
  geometry.alpha1 = geometry.plane.a1 * std::cos(geometry.roll_rad) - geometry.plane.a2 * std::sin(geometry.roll_rad);
  geometry.residual_px = std::sqrt(std::max(moments.residuals / moments.n, 0.0));
  geometry.roll_stderr_rad = roll_standard_error(moments, geometry.plane);
  geometry.roll_observable = observable(geometry, width, height, options);
}

}  // namespace roadstereo
