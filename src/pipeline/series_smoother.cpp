#include "roadstereo/series_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

/// Value and velocity with their covariance, in units of the scale of all variances.
struct State {
  double x = 0, dx = 0;
  double xx = 0, xd = 0, dd = 0;  ///< covariance
};

/// A known sample.
struct Known {
  double step = 0;  ///< time since the last one
  double value = 0;
  double variance = 1;
};

struct Filtered {
  State predicted, updated;
};

struct Likelihood {
  double log = 0;
  double scale = 1;  ///< maximum-likelihood factor of all variances
};

/// Transition over `step` with white acceleration of spectral density `q`.
State predict(const State& s, double step, double q) {
  const double h = step;
  return {s.x + h * s.dx, s.dx, s.xx + h * (2 * s.xd + h * s.dd) + q * h * h * h / 3, s.xd + h * s.dd + q * h * h / 2,
          s.dd + q * h};
}

State update(const State& s, const Known& sample) {
  const double variance = s.xx + sample.variance, gain = s.xx / variance, rate_gain = s.xd / variance;
  const double innovation = sample.value - s.x;
  return {s.x + gain * innovation, s.dx + rate_gain * innovation, s.xx * (1 - gain), s.xd * (1 - gain),
          s.dd - rate_gain * s.xd};
}

/// The state starts at the first sample with unknown velocity, so that the first two innovations contain no information
/// about the noise.
Likelihood filter(const std::vector<Known>& samples, double q, double velocity_variance,
                  std::vector<Filtered>& states) {
  constexpr std::size_t free_values = 2;
  states.resize(samples.size());
  State state{samples[0].value, 0, samples[0].variance, 0, velocity_variance};
  states[0] = {state, state};
  double log_variances = 0, squares = 0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const State predicted = predict(state, samples[k].step, q);
    state = update(predicted, samples[k]);
    states[k] = {predicted, state};
    if (k < free_values) continue;
    const double variance = predicted.xx + samples[k].variance, innovation = samples[k].value - predicted.x;
    log_variances += std::log(variance);
    squares += innovation * innovation / variance;
  }
  const auto n = static_cast<double>(samples.size() - free_values);
  const double scale = std::max(squares / n, 1e-300);
  return {-0.5 * (log_variances + n * std::log(scale)), scale};
}

/// One step of the Rauch–Tung–Striebel recursion, from the smoothed state of the next sample.
State smooth_step(const State& updated, double step, const State& predicted, const State& smoothed) {
  // G = P Fᵀ P'⁻¹, with F = [1 step; 0 1].
  const double determinant = predicted.xx * predicted.dd - predicted.xd * predicted.xd;
  if (!(determinant > 0)) return updated;
  const double pxx = updated.xx + step * updated.xd, pxd = updated.xd;
  const double pdx = updated.xd + step * updated.dd, pdd = updated.dd;
  const double g00 = (pxx * predicted.dd - pxd * predicted.xd) / determinant;
  const double g01 = (pxd * predicted.xx - pxx * predicted.xd) / determinant;
  const double g10 = (pdx * predicted.dd - pdd * predicted.xd) / determinant;
  const double g11 = (pdd * predicted.xx - pdx * predicted.xd) / determinant;
  const double ex = smoothed.x - predicted.x, ed = smoothed.dx - predicted.dx;
  const double cxx = smoothed.xx - predicted.xx, cxd = smoothed.xd - predicted.xd, cdd = smoothed.dd - predicted.dd;
  return {updated.x + g00 * ex + g01 * ed, updated.dx + g10 * ex + g11 * ed,
          updated.xx + g00 * g00 * cxx + 2 * g00 * g01 * cxd + g01 * g01 * cdd,
          updated.xd + g00 * g10 * cxx + (g00 * g11 + g01 * g10) * cxd + g01 * g11 * cdd,
          updated.dd + g10 * g10 * cxx + 2 * g10 * g11 * cxd + g11 * g11 * cdd};
}

std::vector<State> smooth(const std::vector<Known>& samples, const std::vector<Filtered>& filtered) {
  std::vector<State> smoothed(samples.size());
  smoothed.back() = filtered.back().updated;
  for (std::size_t k = samples.size() - 1; k-- > 0;) {
    smoothed[k] = smooth_step(filtered[k].updated, samples[k + 1].step, filtered[k + 1].predicted, smoothed[k + 1]);
  }
  return smoothed;
}

double median_step(const std::vector<Known>& samples) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < samples.size(); ++k) steps.push_back(samples[k].step);
  const double median = upper_median(steps);
  return median > 0 ? median : 1;
}

/// Filter with the density of the acceleration that makes the samples likeliest. Returns the scale of the variances.
double filter_likeliest(const std::vector<Known>& samples, double variance, std::vector<Filtered>& states) {
  constexpr int first_exponent = -36, last_exponent = 20;  // quarters of a decade
  constexpr double unknown_velocity = 1e8;                 // variance, of the samples' one in the square of a step
  const double step = median_step(samples), velocity_variance = unknown_velocity * variance / (step * step);
  double best_q = 0;
  Likelihood best{-HUGE_VAL, 1};
  for (int exponent = first_exponent; exponent <= last_exponent; ++exponent) {
    const double q = std::pow(10.0, 0.25 * exponent) * variance / (step * step * step);
    const Likelihood likelihood = filter(samples, q, velocity_variance, states);
    if (likelihood.log <= best.log) continue;
    best = likelihood;
    best_q = q;
  }
  return filter(samples, best_q, velocity_variance, states).scale;
}

}  // namespace

std::vector<Measurement> smooth_series(std::span<const SeriesSample> samples) {
  constexpr std::size_t min_samples = 5;
  std::vector<Measurement> result;
  std::vector<std::size_t> known;
  std::vector<double> errors;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    result.push_back({samples[k].value, samples[k].std_error});
    if (!std::isfinite(samples[k].value)) continue;
    known.push_back(k);
    if (samples[k].std_error > 0 && std::isfinite(samples[k].std_error)) errors.push_back(samples[k].std_error);
  }
  const bool have_errors = !errors.empty();
  const double typical_error = have_errors ? upper_median(errors) : 1;
  if (known.size() < min_samples) return result;
  std::vector<Known> series;
  std::vector<double> variances;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const SeriesSample& sample = samples[known[i]];
    const double step = i == 0 ? 0 : std::max(0.0, sample.time - samples[known[i - 1]].time);
    const bool is_known = sample.std_error > 0 && std::isfinite(sample.std_error);
    const double std_error = is_known ? sample.std_error : typical_error;
    variances.push_back(std_error * std_error);
    series.push_back({step, sample.value, variances.back()});
  }
  std::vector<Filtered> filtered;
  const double scale = filter_likeliest(series, upper_median(std::vector(variances)), filtered);
  const std::vector<State> smoothed = smooth(series, filtered);
  const double common_share = have_errors ? std::max(0.0, 1 - scale) : 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double variance = scale * smoothed[i].xx + common_share * series[i].variance;
    result[known[i]] = {smoothed[i].x, std::sqrt(std::max(0.0, variance))};
  }
  return result;
}

}  // namespace roadstereo
