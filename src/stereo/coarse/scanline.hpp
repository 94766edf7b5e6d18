#pragma once

#include <cstddef>

// Scanline optimisation (1-D semi-global matching): the exact minimum over the disparities of a row of costs and
// truncated penalties of changes, by dynamic programming forward and backward.

namespace roadstereo {

/// Costs of one row of pixels: disparity d of column u at costs[u·pitch + d], aligned for vectors. `pitch` is a
/// multiple of 16; elements behind the last disparity are overwritten.
struct ScanlineCosts {
  float* costs;
  std::ptrdiff_t pitch;
  int columns;
  int disparities;
  int first_seen;  ///< column u has a counterpart up to disparity u − first_seen
};

/// Prior of a row: disparity d of column u costs weight[u] · min(|d − centre[u]|, truncation[u])² more.
struct ScanlinePrior {
  const float* centre;  ///< NaN: no prior
  const float* weight;
  const float* truncation;
};

/// Penalties of a change of the disparity from one pixel to the next.
struct ScanlinePenalties {
  float step;  ///< by one
  float jump;  ///< by more
};

/// Guard elements of infinite cost before and behind the disparities of a column.
inline constexpr std::ptrdiff_t scanline_guard = 16;

/// Returns the elements of scratch memory, aligned for vectors, that a row needs.
std::size_t scanline_scratch(int columns, std::ptrdiff_t pitch);

/// Writes the guards in scratch memory, which optimise_scanlines leaves as they are: once for all rows of this size.
void guard_scanline_scratch(int columns, std::ptrdiff_t pitch, int disparities, float* scratch);

/// One row of pixels.
struct Scanline {
  ScanlineCosts costs;
  ScanlinePrior prior;
  float* scratch;    ///< with its guards
  float* disparity;  ///< result
};

/// Writes for every column of one or two rows of the same size the disparity with the smallest total cost of all paths
/// along its row through it, with its fraction (stereo/coarse/path_winner.hpp); NaN where the column has no
/// counterpart. Disparities without a counterpart cost `uncorrelated_cost` and never win. Two rows take less time than
/// one after the other: their paths hide each other's latency.
void optimise_scanlines(const Scanline* rows, int count, const ScanlinePenalties& penalties, float uncorrelated_cost);

}  // namespace roadstereo
