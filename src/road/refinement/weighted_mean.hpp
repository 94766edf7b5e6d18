#pragma once

#include <span>

#include "road/refinement/mean_settings.hpp"

namespace roadstereo {

/// One row of what is averaged; both can be read a radius beyond either end of the row.
struct MeasuredRow {
  const float* value;      ///< disparities; any finite number where there is none
  const float* precision;  ///< 1 / variance; 0 where there is none
  const float* variance;   ///< large, but finite, where there is none
};

/// Neighbours that a row of the window takes in: the columns first, first + step, … up to −first.
struct WindowLine {
  MeasuredRow row;
  int first;
  int step;
};

/// mean[u], precision[u] for u in [0, width): the mean of the window's neighbours q of u, weighted by their precision
/// and by (1 − (value(q) − value(u))² / (reach² (variance(q) + variance(u))))², 0 beyond reach; and its precision, less
/// for neighbours that scatter by more than their variances. Writes whole vectors: up to 16 elements behind `width`.
void weighted_mean(const MeasuredRow& centre, std::span<const WindowLine> window, const MeanSettings& settings,
                   int width, float* mean, float* precision);

}  // namespace roadstereo
