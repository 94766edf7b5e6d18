#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// A disparity and its standard error, pixels; NaN unknown.
struct MapPixel {
  float disparity, sigma;
};

/// Where two matched pixels differ by more, above the road, an edge lies between them, pixels.
constexpr float max_interpolated_step_px = 1;

/// The pixel halfway between two that were matched. `half_rise`: by how much the road's disparity grows from the first
/// to it. C++17, for kernels.
ROADSTEREO_HD inline MapPixel between_pixels(const MapPixel& a, const MapPixel& b, float half_rise) {
  const float from_a = a.disparity + half_rise, from_b = b.disparity - half_rise;
  const bool known_a = from_a == from_a, known_b = from_b == from_b;
  const bool take_a = known_a && (!known_b || a.sigma <= b.sigma);
  const bool no_edge = fabsf(from_a - from_b) <= max_interpolated_step_px;
  const float sigma = a.sigma < b.sigma ? b.sigma : a.sigma;
  const float one = take_a ? from_a : from_b, of_one = take_a ? a.sigma : b.sigma;
  return {no_edge ? 0.5F * (from_a + from_b) : one, no_edge ? sigma : of_one};
}

}  // namespace roadstereo
