#pragma once

#include <cstdint>

#include "damage/box_mask.hpp"

namespace roadstereo {

/// Morphological dilation of a mask (0 or 255) by a square of 2·radius + 1 cells.
Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int radius, int threads);

/// Morphological erosion by a square of 2·radius + 1 cells. Cells beyond the border count as set.
Image<std::uint8_t> erode(const Image<std::uint8_t>& mask, int radius, int threads);

/// Dilate or erode the part of a mask inside `box`; the result is stored in `box`. The rectangle has 2·columns + 1 by
/// 2·rows + 1 cells.
BoxMask dilate(const BoxMask& mask, int columns, int rows, const CellBox& box);
BoxMask dilate(const BoxMask& mask, int radius, const CellBox& box);
BoxMask erode(const BoxMask& mask, int radius, const CellBox& box);

}  // namespace roadstereo
