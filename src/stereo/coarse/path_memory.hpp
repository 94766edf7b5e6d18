#pragma once

#include <cstddef>

#include "stereo/coarse/scanline.hpp"

namespace roadstereo {

/// Where the totals of the paths are kept.
struct PathMemory {
  std::ptrdiff_t pitch;   ///< disparities and guards
  float* last_totals[2];  ///< totals of the paths from the right, of the last two columns alternately
  float* forward;         ///< totals of the paths from the left, `pitch` elements a column
  float* backward;        ///< costs of the paths from the right, without the column's own

  PathMemory(int columns, std::ptrdiff_t disparities, float* scratch)
      : pitch(disparities + scanline_guard),
        last_totals{scratch + scanline_guard, scratch + scanline_guard + pitch},
        forward(last_totals[1] + pitch),
        backward(forward + columns * pitch) {}
};

}  // namespace roadstereo
