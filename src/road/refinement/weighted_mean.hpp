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

/// Slopes of the heights at the pixels of a row, pixels of disparity a pixel, along it and down the columns.
struct SlopeRow {
  const float *across, *down;
};

/// Neighbours that a row of the window takes in: the columns first, first + step, … up to −first, `below` rows below.
struct WindowLine {
  MeasuredRow row;
  int below;
  int first;
  int step;
};

/// mean[u], precision[u] for u in [0, width): the mean of what the window's neighbours q of u say of it, their value
/// less what the slopes at u let expect, weighted by their precision and by (1 − Δ² / (reach² (variance(q) +
/// variance(u))))², Δ its difference from value(u), 0 beyond reach; and its precision, less for neighbours that scatter
/// by more than their variances. Reads and writes whole vectors: up to 16 elements behind `width`.
void weighted_mean(const MeasuredRow& centre, const SlopeRow& slopes, std::span<const WindowLine> window,
                   const MeanSettings& settings, int width, float* mean, float* precision);

}  // namespace roadstereo
