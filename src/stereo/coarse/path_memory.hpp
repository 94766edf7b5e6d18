#pragma once

#include <cstddef>

#include "stereo/coarse/scanline.hpp"

namespace roadstereo {

/// The winners of the columns of a row: see PathWinner.
struct PathWinners {
  static constexpr std::ptrdiff_t arrays = 8;

  float *disparity, *before, *at, *after, *own_before, *own_at, *own_after;
  float* inside;  ///< 1, or 0 where the winner is the first or the last disparity

  PathWinners(int columns, float* scratch)
      : disparity(scratch),
        before(disparity + columns),
        at(before + columns),
        after(at + columns),
        own_before(after + columns),
        own_at(own_before + columns),
        own_after(own_at + columns),
        inside(own_after + columns) {}
};

/// Where the totals of the paths are kept, and the winners.
struct PathMemory {
  std::ptrdiff_t pitch;   ///< disparities and guards
  float* last_totals[2];  ///< totals of the paths from the right, of the last two columns alternately
  float* forward;         ///< totals of the paths from the left, `pitch` elements a column
  float* backward;        ///< costs of the paths from the right, without the column's own
  PathWinners winners;

  PathMemory(int columns, std::ptrdiff_t disparities, float* scratch)
      : pitch(disparities + scanline_guard),
        last_totals{scratch + scanline_guard, scratch + scanline_guard + pitch},
        forward(last_totals[1] + pitch),
        backward(forward + columns * pitch),
        winners(columns, backward + columns * pitch) {}
};

}  // namespace roadstereo
