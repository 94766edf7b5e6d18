#pragma once

#include <limits>
#include <span>
#include <vector>

#include "roadstereo/measurement.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// One measurement of a series.
struct SeriesSample {
  double time = 0;                                              ///< not descending; its unit has no effect
  double value = std::numeric_limits<double>::quiet_NaN();      ///< NaN unknown
  double std_error = std::numeric_limits<double>::quiet_NaN();  ///< of `value`, above 0; NaN unknown
};

/// Smooth a series: Kalman filter with constant velocity and white acceleration, and Rauch–Tung–Striebel smoother
/// (1965). The ratio of process to measurement noise and their scale are those of maximum likelihood. Standard errors
/// are used if any known sample has one; samples without one get the median. If they are larger than the scatter
/// explains, the excess is treated as an error common to all samples. Smoothing cannot reduce it, and it remains in the
/// returned standard errors. Returns one value per sample, NaN where the sample is NaN; fewer than 5 known samples are
/// returned as they are.
std::vector<Measurement> smooth_series(std::span<const SeriesSample> samples);

}  // namespace roadstereo
#pragma GCC visibility pop
