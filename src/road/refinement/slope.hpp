#pragma once

#include "roadstereo/host_device.hpp"

// Slope of the heights at a pixel, by which its neighbours are expected to differ. C++17, for kernels.

namespace roadstereo {

struct SlopeSettings {
  int step = 1;       ///< distance of the boxes' centres from the pixel; they are 2·step − 1 pixels wide and high
  float samples = 1;  ///< pixels that one disparity rests on: as many of a box tell what one does
};

/// Largest step: such boxes fit into the shared memory of a GPU.
constexpr int max_slope_step = 8;

/// Mean of the heights in a box, weighted by their precisions, and the sum of these, 0 where none is known.
struct BoxMean {
  float height;
  float precision;
};

ROADSTEREO_HD inline BoxMean box_mean(float weighted_heights, float precision) {
  return {precision > 0 ? weighted_heights / precision : 0.0F, precision};
}

/// Slope along a row or column, pixels of disparity a pixel, and its square over its variance.
struct Slope {
  float value;
  float significance;
};

/// The slope between the boxes before and after a pixel: the harmonic mean of those from and to its own height, 0 where
/// they differ in sign (van Leer's limiter, 1974). Beside a step, where one of them is 0, there is none.
ROADSTEREO_HD inline Slope limited_slope(float height, const BoxMean& before, const BoxMean& after,
                                         const SlopeSettings& settings) {
  const auto step = static_cast<float>(settings.step);
  const float from = (height - before.height) / step, to = (after.height - height) / step;
  const float product = from * to, both = before.precision * after.precision;
  const bool known = product > 0 && both > 0;
  const float value = known ? 2 * product / (from + to) : 0.0F;
  // The boxes' means are 2·step apart; 1/precision is a variance.
  const float variance = (before.precision + after.precision) * settings.samples;
  return {value, known ? 4 * step * step * value * value * both / variance : 0.0F};
}

/// Significance of noise along both axes together, in the mean.
constexpr float slope_of_noise = 2;

/// Share of the slopes that is expected to be no noise: a Wiener filter.
ROADSTEREO_HD inline float slope_share(const Slope& across, const Slope& down) {
  const float significance = across.significance + down.significance;
  return significance / (significance + slope_of_noise);
}

}  // namespace roadstereo
