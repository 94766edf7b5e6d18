#pragma once

#include <cmath>

#include "road/robust_weights.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/host_device.hpp"
#include "roadstereo/uncontracted.hpp"

// The formulas of the transformed disparity and its spread, which are measured on the host and on the device.
namespace roadstereo {

/// ℓ(p) − α0 + α1 (u sin ψ − v cos ψ): height above (or depth below) the road, in pixels of disparity, from the road's
/// line in the row. In single precision, since small GPUs have hardly any other; the same bits on host and device.
ROADSTEREO_HD inline float above_road(float disparity, const RowLine& road, int u) {
  return disparity - road.offset - uncontracted_product(road.slope, static_cast<float>(u));
}

/// δt: the smallest whole number that makes every value positive, at least `least`; `smallest` is that of the heights,
/// infinite without any.
ROADSTEREO_HD inline double derived_delta_t(double smallest, double least) {
  const double needed = std::isfinite(smallest) ? std::floor(-smallest) + 1 : 0;
  const double wished = std::ceil(least);
  return wished < needed ? needed : wished;
}

/// Regular sample of a map that its spread is first judged by.
ROADSTEREO_HD inline int spread_step(double pixels) {
  const int step = static_cast<int>(std::sqrt(pixels / 12000));
  return step > 1 ? step : 1;
}

/// Only residuals up to this are used at first, so that objects on the road or beside it do not widen the limit.
inline constexpr double spread_nearest_px = 3.0;

/// Residuals up to this are the road's; `median` is that of the near ones' magnitudes.
ROADSTEREO_HD inline double spread_limit(double median) {
  constexpr double min_limit_px = 1.0;
  const double limit = 3 * gaussian_mad * median;
  return limit < min_limit_px ? min_limit_px : limit;
}

/// Sums behind a standard deviation.
struct Spread {
  double n, sum, squares;

  ROADSTEREO_HD void add(double value) {
    n += 1;
    sum += value;
    squares += value * value;
  }
  ROADSTEREO_HD void add(const Spread& other) {
    n += other.n;
    sum += other.sum;
    squares += other.squares;
  }
  ROADSTEREO_HD double deviation() const {
    if (!(n > 0)) return 0;
    const double variance = squares / n - sum / n * (sum / n);
    return variance > 0 ? std::sqrt(variance) : 0;
  }
};

}  // namespace roadstereo
