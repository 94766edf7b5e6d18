#pragma once

#include <algorithm>

#include "core/max_disparities.hpp"
#include "roadstereo/coarse_search.hpp"
#include "roadstereo/perspective_shift.hpp"

// Sizes of the coarse search, on the host and on the device.

namespace roadstereo {

inline constexpr int min_ranged_disparities = 12;  ///< fewer disparities have no tile ranges

/// Whether a pair is large enough for the coarse search.
inline bool coarse_search_pays(int width, int height) {
  constexpr int min_side = 64;
  return std::min(width, height) >= min_side;
}

/// Returns the disparities searched in the downsampled pair.
inline int coarse_disparities(int disparities, int factor) {
  return std::max(2, (disparities - 1) / factor + 1);
}

/// Returns the downsampling factor. The first and the last disparity have no fraction: with few of them that would be
/// the road's.
inline int coarse_factor(const CoarseSearchOptions& options, int width, int disparities) {
  constexpr int max_columns = 800, min_disparities = 7;
  if (options.factor != 0) return options.factor;
  int factor = 2;
  while (factor < 8 && width / factor > max_columns && coarse_disparities(disparities, 2 * factor) >= min_disparities) {
    factor *= 2;
  }
  return factor;
}

/// Returns `factor`, halved while less than two disparities are left between the first and the last.
inline int factor_with_fractions(int factor, int disparities) {
  constexpr int min_disparities = 4;
  while (factor > 2 && coarse_disparities(disparities, factor) < min_disparities) factor /= 2;
  return factor;
}

/// Returns the disparities of all that a W×H picture shows, up to that of what stands on the nearest road in it; at
/// most as many as a matcher takes.
inline int scene_disparities(const PerspectiveShift& shift, int width, int height) {
  const DisparityPlane& road = shift.road;
  const double nearest = std::max(road.disparity(0, height - 1), road.disparity(width - 1, height - 1));
  return static_cast<int>(std::clamp(shift.delta_p + nearest, 1.0, std::min(width / 4.0, max_disparities - 1.0))) + 1;
}

}  // namespace roadstereo
