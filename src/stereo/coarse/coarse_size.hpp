#pragma once

#include <algorithm>

#include "roadstereo/coarse_search.hpp"

// Sizes of the coarse search, on the host and on the device.

namespace roadstereo {

inline constexpr int min_ranged_disparities = 12;  ///< fewer disparities have no tile ranges

/// Whether a pair is large enough for the coarse search.
inline bool coarse_search_pays(int width, int height) {
  constexpr int min_side = 64;
  return std::min(width, height) >= min_side;
}

/// Returns the downsampling factor.
inline int coarse_factor(const CoarseSearchOptions& options, int width) {
  constexpr int max_columns = 800;
  if (options.factor != 0) return options.factor;
  int factor = 2;
  while (factor < 8 && width / factor > max_columns) factor *= 2;
  return factor;
}

/// Returns the disparities searched in the downsampled pair.
inline int coarse_disparities(int disparities, int factor) {
  return std::max(2, (disparities - 1) / factor + 1);
}

}  // namespace roadstereo
