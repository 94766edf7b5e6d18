#pragma once

#include <cstddef>

#include "road/refinement/slope.hpp"

// Slopes of the pixels of a row, with the instruction set of the machine.

namespace roadstereo {

/// Heights above the road of a row, any finite number where unknown, and their precisions, 0 there.
struct HeightRow {
  const float *value, *precision;
};

/// Sums over boxes around the pixels of a row: heights weighted by their precisions, and these. As means: the mean
/// height, 0 where none is known.
struct BoxRow {
  float *heights, *precision;
};

/// Sums over 2·radius + 1 columns, at the columns of [first, end).
void sum_columns(const HeightRow& row, int radius, int first, int end, const BoxRow& sums);

/// Adds up `count` rows of sums, `pitch` apart from `rows` on, to means, at the columns of [first, end).
void mean_of_rows(const BoxRow& rows, std::ptrdiff_t pitch, int count, int first, int end, const BoxRow& means);

/// Boxes around the pixels of a row, a step above it and a step below it.
struct NearBoxes {
  BoxRow here, above, below;
};

/// Slopes at the columns of [0, width), pixels of disparity a pixel (slope.hpp), shrunk by their share. Reads and
/// writes whole vectors: up to 16 elements behind `width`.
void row_slopes(const float* heights, const NearBoxes& boxes, const SlopeSettings& settings, int width, float* across,
                float* down);

}  // namespace roadstereo
