#include "roadstereo/health.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cholesky.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/require_size.hpp"
#include "pipeline/picture_health.hpp"
#include "pipeline/rectification_error.hpp"

namespace roadstereo {
namespace {

/// Largest residual of a quadratic in u and v fitted to the disparity errors at the samples on the road. The rig bias
/// that is already subtracted (`undone`) is taken off first, but only if the fit itself shows distortion.
double beyond_quadratic(const std::vector<RowSample>& samples, const DamageMap& damage, const RectificationError& fit,
                        const std::optional<RigBias>& undone) {
  constexpr std::size_t terms = 6, min_points = 20;
  constexpr double smallest = 1e-10;
  const bool counts = undone && fit.has_distortion();
  struct Point {
    Vector<terms> row;
    double value;
  };
  std::vector<Point> points;
  Matrix<terms> a{};
  Vector<terms> b{};
  for (const RowSample& sample : samples) {
    if (damage.road(static_cast<int>(sample.u), static_cast<int>(sample.v)) == 0) continue;
    const double x = sample.u / damage.road.width(), y = sample.v / damage.road.width();
    const double error = fit.disparity_error_px(sample.u, sample.v, -sample.du);
    const Point& point = points.emplace_back(
        Point{{1, x, y, x * x, x * y, y * y}, error - (counts ? undone->at(sample.u, sample.v) : 0)});
    for (std::size_t i = 0; i < terms; ++i) {
      b[i] += point.row[i] * point.value;
      for (std::size_t j = 0; j <= i; ++j) a[i][j] += point.row[i] * point.row[j];
    }
  }
  if (points.size() < min_points) return PairHealth::unknown;
  factor_in_place(a, smallest);
  const Vector<terms> surface = solve_factored(a, b);
  double largest = 0;
  for (const Point& point : points) {
    double rest = point.value;
    for (std::size_t i = 0; i < terms; ++i) rest -= surface[i] * point.row[i];
    largest = std::max(largest, std::abs(rest));
  }
  return largest;
}

/// The fit holds where there are samples: elsewhere it would extrapolate cubes.
void measure_rectification(const FrameResult& frame, const DamageMap& damage,
                           const std::optional<StereoCalibration>& calibration, int threads, PairHealth& health) {
  constexpr double share = 0.9;
  const std::vector<RowSample> samples = sample_row_alignment(frame.grey, frame.right, threads, frame.mask);
  const auto fit = fit_rectification_error(samples, frame.grey.width(), frame.grey.height(), calibration);
  if (!fit) return;
  if (fit->is_known() || neighbours_agree(samples)) health.row_scatter_px = fit->scatter_px;
  if (!fit->is_known()) return;
  const auto& [offset, scale, turn, right, both] = fit->value;
  health.row_offset_px = fit->focal_px * offset;
  const Misalignment& undone = frame.shift.misalignment;
  health.row_correction_px = undone.rows_at(fit->right_cx_px, fit->cy_px);
  health.row_scale = scale;
  health.row_turn_rad = turn;
  health.distortion_right = right;
  health.distortion_both = both;
  std::vector<double> errors;
  errors.reserve(samples.size());
  for (const RowSample& sample : samples) {
    errors.push_back(std::abs(health.row_offset_px + fit->slope_px(sample.u, sample.v, -sample.du) -
                              undone.rows_at(sample.u + sample.du, sample.v)));
  }
  health.row_error_px = lower_quantile(errors, share);
  health.bowl_px = beyond_quadratic(samples, damage, *fit, frame.rig_bias);
}

/// Robust standard deviation (MAD), as that of the noise, of the medians of the road's rows around its surface.
double measure_wave(const FrameResult& frame, const DamageMap& damage) {
  constexpr int rows = 4, step = 4;
  constexpr std::size_t min_columns = 40, min_bands = 20;
  std::vector<double> medians;
  std::vector<float> residuals;
  for (int v = 0; v + rows <= frame.transformed.height(); v += rows) {
    residuals.clear();
    for (int u = 0; u < frame.transformed.width(); u += step) {
      if (damage.road(u, v) == 0 || damage.ids(u, v) != 0) continue;
      const float residual = damage.surface(u, v) - frame.transformed(u, v);
      if (std::isfinite(residual)) residuals.push_back(residual);
    }
    if (residuals.size() >= min_columns) medians.push_back(static_cast<double>(upper_median(residuals)));
  }
  if (medians.size() < min_bands) return PairHealth::unknown;
  return gaussian_mad * upper_median_magnitude(medians);
}

/// Smallest disparities where the plane of the road lies beyond infinity.
double measure_infinity(const FrameResult& frame, const std::optional<StereoCalibration>& calibration) {
  constexpr int step = 4;
  constexpr double margin_px = 2, share = 0.1;
  constexpr float max_sigma_px = 0.3F;
  constexpr std::size_t min_pixels = 200;
  const double offset = calibration ? calibration->disparity_offset_px : 0;
  std::vector<double> values;
  for (int v = 0; v < frame.disparity.height(); v += step) {
    for (int u = 0; u < frame.disparity.width(); u += step) {
      if (frame.geometry.plane.disparity(u, v) + offset > -margin_px) continue;
      if (!(frame.sigma(u, v) < max_sigma_px) || std::isnan(frame.disparity(u, v))) continue;
      values.push_back(double{frame.disparity(u, v)} + offset);
    }
  }
  return values.size() < min_pixels ? PairHealth::unknown : lower_quantile(values, share);
}

}  // namespace

PairHealth measure_health(const FrameResult& frame, const DamageMap& damage,
                          const std::optional<StereoCalibration>& calibration, const DamageOptions& options,
                          int threads) {
  PairHealth health;
  health.threshold_sigma = options.threshold_sigma;
  if (!frame.roll_found || frame.grey.empty() || frame.right.empty()) return health;
  require_same_size("the damage map", map_size(damage.road), "the disparity map", map_size(frame.disparity));
  health.noise_px = damage.noise_px;
  constexpr int parts = 4;
  parallel_for(parts, threads, [&](int part, int) {
    switch (part) {
      case 0:
        measure_rectification(frame, damage, calibration, threads, health);
        break;
      case 1:
        measure_pictures(frame, damage, threads, health);
        break;
      case 2:
        health.wave_px = measure_wave(frame, damage);
        break;
      default:
        if (!frame.sigma.empty()) health.infinity_px = measure_infinity(frame, calibration);
    }
  });
  return health;
}

void withhold_severity(const PairHealth& health, DamageMap& damage) {
  if (health.depth_is_trusted()) return;
  for (auto* const list : {&damage.damages, &damage.candidates}) {
    for (Damage& one : *list) {
      if (!one.metrics) continue;
      one.metrics->severity = Severity::unknown;
      one.metrics->severity_probabilities = {};
    }
  }
}

}  // namespace roadstereo
