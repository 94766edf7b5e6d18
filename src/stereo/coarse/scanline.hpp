#pragma once

#include <cstddef>

namespace roadstereo {

/// The costs of one row of pixels: disparity d of column u at costs[u·pitch + d], aligned for vectors. `pitch` is a
/// multiple of 16; what lies behind the last disparity is overwritten.
struct ScanlineCosts {
  float* costs;
  std::ptrdiff_t pitch;
  int columns;
  int disparities;
  int first_seen;  ///< column u has a counterpart up to disparity u − first_seen
};

/// What the pixels of a row are guessed to be: disparity d of column u costs pull[u] · min(|d − centre[u]|, reach)
/// more.
struct ScanlineGuess {
  const float* centre;  ///< NaN: no guess
  const float* pull;
  float reach;
};

/// Penalties of a change of the disparity from one pixel to the next.
struct ScanlinePenalties {
  float step;  ///< by one
  float jump;  ///< by more
};

/// Elements that never win before and behind the disparities of a column of paths.
inline constexpr std::ptrdiff_t scanline_guard = 16;

/// Elements of scratch memory, aligned for vectors, that optimise_scanline needs.
std::size_t scanline_scratch(int columns, std::ptrdiff_t pitch);

/// Takes for every column the disparity of the smallest total cost among all paths along the row that pass through it:
/// costs of the pixels, guesses and penalties of the changes, by dynamic programming forth and back. Its fraction is
/// that of eq. subpixel on the total costs; NaN where a column has no counterpart at all. A disparity without a
/// counterpart costs `no_evidence`, and is never taken.
void optimise_scanline(const ScanlineCosts& row, const ScanlineGuess& guess, const ScanlinePenalties& penalties,
                       float no_evidence, float* scratch, float* disparity);

}  // namespace roadstereo
