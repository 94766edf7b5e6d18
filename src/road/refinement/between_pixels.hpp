#pragma once

#include <cmath>

#include "road/refinement/measured.hpp"
#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Where two matched pixels differ by more, above the road, an edge lies between them, pixels.
constexpr float max_interpolated_step_px = 1;

/// The pixel halfway between two that were matched. `half_rise`: by how much the road's disparity grows from the first
/// to it. C++17, for kernels.
ROADSTEREO_HD inline RefinedPixel between_pixels(const RefinedPixel& a, const RefinedPixel& b, float half_rise) {
  const float from_a = a.disparity + half_rise, from_b = b.disparity - half_rise;
  const bool known_a = from_a == from_a, known_b = from_b == from_b;
  const bool take_a = known_a && (!known_b || a.error <= b.error);
  const bool no_edge = fabsf(from_a - from_b) <= max_interpolated_step_px;
  const float error = 0.5F * (a.error + b.error);
  const float one = take_a ? from_a : from_b, of_one = take_a ? a.error : b.error;
  return {no_edge ? 0.5F * (from_a + from_b) : one, no_edge ? error : of_one};
}

}  // namespace roadstereo
