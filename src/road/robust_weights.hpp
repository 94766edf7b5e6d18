#pragma once

#include <cmath>

#include "core/order_statistics.hpp"
#include "core/tukey.hpp"
#include "roadstereo/host_device.hpp"

// The formulas of the robust plane fit, which runs on the host and on the device.
namespace roadstereo {

/// Residuals below this are rounding, not noise.
inline constexpr double min_scale_px = 1e-3;

/// The scale after a step: that of the residuals in the window that is left, so that it narrows onto the road.
ROADSTEREO_HD inline double narrowed_scale(double median_magnitude, double scale) {
  const double wished = gaussian_mad * median_magnitude;
  if (wished < min_scale_px) return min_scale_px;
  return wished > scale ? scale : wished;
}

/// Whether a step that changed the plane by `by_px` at a far point and by `by_a2`, and the scale from one to another,
/// was the last: a fiftieth of the standard errors σ/√n that the noise of `points` residuals leaves, over a thousand
/// columns for the slope.
ROADSTEREO_HD inline bool robust_fit_settled(double by_px, double by_a2, double scale, double last_scale,
                                             double points) {
  constexpr double share2 = 0.02 * 0.02, columns2 = 1e6;
  const double limit2 = share2 * scale * scale, narrowed = last_scale - scale;
  return points > 0 && by_px * by_px * points < limit2 && by_a2 * by_a2 * columns2 * points < limit2 &&
         narrowed * narrowed * points < share2 * last_scale * last_scale;
}

/// The largest scale that the robust fit of a map begins with: too narrow for most kerbs.
inline constexpr double max_start_scale_px = 0.6;

/// From the quantile of least_quantile.hpp: of a road alone, with normal noise, half of the residuals are within it.
ROADSTEREO_HD inline double start_scale_of(double quantile_px) {
  const double scale = gaussian_mad * quantile_px;
  if (scale < min_scale_px) return min_scale_px;
  return scale > max_start_scale_px ? max_start_scale_px : scale;
}

/// Moments of points of disparity space: their weight, and sums of products of deviations from the means.
struct PlaneMoments {
  double n, uu, uv, vv, ud, vd;
};

/// The slopes a1 (along v) and a2 (along u) of the least-squares plane, a2 = 0 without roll; false when the points lie
/// on one line of the image.
ROADSTEREO_HD inline bool solve_slopes(const PlaneMoments& m, bool with_roll, double& a1, double& a2) {
  if (m.n <= 0 || m.vv <= 1e-9 * m.n) return false;
  if (!with_roll) {
    a1 = m.vd / m.vv;
    a2 = 0;
    return true;
  }
  const double determinant = m.uu * m.vv - m.uv * m.uv;
  if (determinant <= 1e-9 * m.n * m.n) return false;
  const double inverse = 1 / determinant;
  a1 = (m.uu * m.vd - m.uv * m.ud) * inverse;
  a2 = (m.vv * m.ud - m.uv * m.vd) * inverse;
  return true;
}

}  // namespace roadstereo
