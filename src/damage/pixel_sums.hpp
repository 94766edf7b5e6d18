#pragma once

#include <cstddef>
#include <vector>

namespace roadstereo {

/// Standard error from which on a pixel counts as invalid.
inline constexpr float max_sigma_px = 1;

/// Whether the standard error of any pixel of a row exceeds the limit.
bool has_uncertain(const float* sigma, int width);

/// Column sums of the valid pixels of one row of cells.
struct PixelSums {
  std::vector<float> sum;
  std::vector<int> count;  ///< valid pixels

  explicit PixelSums(int columns) : sum(static_cast<std::size_t>(columns)), count(static_cast<std::size_t>(columns)) {}
  void clear();
  /// Add the valid pixels of an image row.
  void add(const float* values, const float* sigma, int width);
};

}  // namespace roadstereo
