#pragma once

#include <algorithm>
#include <cmath>

#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Step, at least `min_step`, of a regular grid of at most about `max_samples` pixels in a box.
inline int sampling_step(const PixelBox& box, double max_samples, int min_step) {
  const double pixels = static_cast<double>(box.width()) * box.height();
  return std::max(min_step, static_cast<int>(std::ceil(std::sqrt(pixels / max_samples))));
}

}  // namespace roadstereo
