#include "road/row_offset_fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"
#include "core/scratch.hpp"
#include "road/plane_fit.hpp"
#include "road/robust_weights.hpp"

namespace roadstereo {
namespace {

/// Slopes need more: errors are not normal, and a few wrong ones at one side of the image look like a turn.
constexpr double min_offset_std_errors = 3, min_slope_std_errors = 5;

/// A robust fit of a constant, or of a plane, to the offsets; relative to the weighted mean of the samples, so that the
/// errors of the constant and of the slopes are independent.
struct Fit {
  double u = 0, v = 0;  ///< mean of the samples
  double constant = 0, per_column = 0, per_row = 0;
  double sigma = 0;  ///< of an offset
  PlaneMoments moments{};

  double at(const RowSample& sample) const {
    return constant + per_column * (sample.u + sample.du - u) + per_row * (sample.v - v);
  }
  bool has_offset() const { return std::abs(constant) * std::sqrt(moments.n) > min_offset_std_errors * sigma; }
  bool has_slopes() const {
    // Standard errors of the slopes along each axis, with the other one unknown.
    const double determinant = moments.uu * moments.vv - moments.uv * moments.uv;
    if (!(determinant > 0)) return false;
    const double of_column = sigma * std::sqrt(moments.vv / determinant);
    const double of_row = sigma * std::sqrt(moments.uu / determinant);
    return std::abs(per_column) > min_slope_std_errors * of_column || std::abs(per_row) > min_slope_std_errors * of_row;
  }
  RowOffset line() const { return {constant - per_column * u - per_row * v, per_column, per_row}; }
};

void refit(std::span<const RowSample> samples, bool with_slopes, Fit& fit) {
  auto residuals = scratch_vector<double>();
  residuals.reserve(samples.size());
  for (const RowSample& sample : samples) residuals.push_back(sample.dv - fit.at(sample));
  auto magnitudes = scratch_vector<double>();
  magnitudes.assign(residuals.begin(), residuals.end());
  fit.sigma = std::max(min_scale_px, gaussian_mad * upper_median_magnitude(magnitudes));
  double n = 0, u = 0, v = 0, dv = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double weight = tukey_weight(residuals[k] / (tukey * fit.sigma));
    n += weight;
    u += weight * (samples[k].u + samples[k].du);
    v += weight * samples[k].v;
    dv += weight * samples[k].dv;
  }
  fit.u = u / n;
  fit.v = v / n;
  fit.constant = dv / n;
  fit.moments = {};
  fit.moments.n = n;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double weight = tukey_weight(residuals[k] / (tukey * fit.sigma));
    const double x = samples[k].u + samples[k].du - fit.u, y = samples[k].v - fit.v, d = samples[k].dv - fit.constant;
    fit.moments.uu += weight * x * x;
    fit.moments.uv += weight * x * y;
    fit.moments.vv += weight * y * y;
    fit.moments.ud += weight * x * d;
    fit.moments.vd += weight * y * d;
  }
  fit.per_column = fit.per_row = 0;
  if (with_slopes) solve_slopes(fit.moments, true, fit.per_row, fit.per_column);
}

Fit fit_robustly(std::span<const RowSample> samples, double start, bool with_slopes) {
  constexpr int iterations = 8;
  Fit fit;
  fit.constant = start;
  for (int i = 0; i < iterations; ++i) refit(samples, with_slopes, fit);
  return fit;
}

}  // namespace

RowOffset fit_row_offset(std::span<const RowSample> samples) {
  auto offsets = scratch_vector<double>();
  offsets.reserve(samples.size());
  for (const RowSample& sample : samples) offsets.push_back(sample.dv);
  const double median = upper_median(offsets);
  const Fit plane = fit_robustly(samples, median, true);
  if (plane.has_slopes()) return plane.line();
  const Fit constant = fit_robustly(samples, median, false);
  return constant.has_offset() ? constant.line() : RowOffset{};
}

}  // namespace roadstereo
