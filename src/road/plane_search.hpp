#pragma once

#include <cmath>

#include "core/parabola.hpp"
#include "roadstereo/grey_scale.hpp"

// Where and how blocks are looked for around a supposed road: on the host and on the device.
namespace roadstereo {

/// Size of a block, (2·half + 1) pixels each way, and what a match must have.
inline constexpr int plane_block_half_width = 7;
inline constexpr int plane_block_half_height = 3;
inline constexpr int plane_block_width = 2 * plane_block_half_width + 1;
inline constexpr int plane_block_height = 2 * plane_block_half_height + 1;
inline constexpr float plane_match_min_deviation = 1.5f * grey_scale;
inline constexpr float plane_match_min_correlation = 0.75f;
inline constexpr float plane_match_min_telling_correlation = 0.3f;  ///< below it chance decides
inline constexpr double plane_match_max_slant = 0.5;  ///< no road's disparity changes by that much per column
inline constexpr int plane_match_max_range = 7;       ///< pixels that a search may look to either side

/// A regular grid of places, row by row.
struct SampleGrid {
  int range_px;
  int pitch;
  int columns;
  int rows;

  ROADSTEREO_HD int places() const { return columns * rows; }
  ROADSTEREO_HD int column(int i) const { return plane_block_half_width + i * pitch; }
  ROADSTEREO_HD int row(int i) const { return plane_block_half_height + i * pitch; }
};

/// About `places` places in an image.
inline SampleGrid sample_grid(int width, int height, int range_px, int places) {
  const int root = static_cast<int>(std::sqrt(static_cast<double>(width) * height / places));
  const int pitch = root > 1 ? root : 1;
  const auto along = [pitch](int size, int half) {
    return size > 2 * half ? (size - 2 * half + pitch - 1) / pitch : 0;
  };
  return {range_px, pitch, along(width, plane_block_half_width), along(height, plane_block_half_height)};
}

/// Pixels of the right image that a block's search takes to either side of where the plane puts it.
ROADSTEREO_HD inline double plane_search_extent(double a1, double a2, int range_px) {
  const double slant = std::fabs(a1) * plane_block_half_height + std::fabs(a2) * (plane_block_half_width + range_px);
  return plane_block_half_width + slant + range_px + 1;
}

/// Above the horizon there is no road; and the whole search must stay inside the right image.
ROADSTEREO_HD inline bool search_in_view(int u, double disparity, double reach, int width) {
  return disparity > 0 && u - disparity - reach >= 0 && u - disparity + reach < width - 1;
}

/// Standard deviation of a block from the sum of its squares.
ROADSTEREO_HD inline double block_deviation(unsigned squares, double mean, double pixels) {
  const double variance = squares / pixels - mean * mean;
  return std::sqrt(variance > 0 ? variance : 0.0);
}

/// Where between its neighbours a peak lies, by the parabola through the three: −½ … ½.
ROADSTEREO_HD inline double parabola_offset(double before, double at, double after) {
  return second_difference(before, at, after) < 0 ? parabola_vertex(before, at, after) : 0;
}

}  // namespace roadstereo
