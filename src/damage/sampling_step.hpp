#pragma once

#include <algorithm>
#include <cmath>

#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Step of a regular grid of at most about `max_samples` pixels in a box: at least every fourth pixel of every fourth
/// row.
inline int sampling_step(const PixelBox& box, double max_samples) {
  constexpr int min_step = 4;
  const double pixels = double{1} * box.width() * box.height();
  return std::max(min_step, static_cast<int>(std::ceil(std::sqrt(pixels / max_samples))));
}

}  // namespace roadstereo
