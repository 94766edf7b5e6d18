#pragma once

#include <cstddef>
#include <cstdint>

#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// The downsampled pair.
struct CoarsePair {
  ImageView<const std::int16_t> reference, target;
  const int* first_column;  ///< of the target in its full size; null: all valid
  int factor;               ///< that it was downsampled by
};

/// Numbers of the pixels and disparities of a band of rows: disparity d of column u of row first_row + r at
/// ((r·columns) + u)·pitch + d. The pitch is a multiple of a warp; behind the last disparity costs are infinite.
struct CoarseVolume {
  float* numbers;
  int columns, disparities;
  int pitch;
  int first_row, rows;

  ROADSTEREO_HD float* pixel(int u, int v) const {
    return numbers + (static_cast<std::ptrdiff_t>(v - first_row) * columns + u) * pitch;
  }
};

}  // namespace roadstereo::cuda
