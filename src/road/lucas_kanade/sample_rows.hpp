#pragma once

#include <cstddef>
#include <cstdint>

#include "road/row_shift.hpp"

// Samples of a row of pixels for the Gauss–Newton step, with the instruction set of the machine.

namespace roadstereo {

/// Numbers before and behind a row that may be read.
constexpr int sample_guard = 16;

/// Rows of sums, in the order of `AlignmentSums`.
constexpr std::size_t alignment_sum_count = 10;

/// A row of both images, prefiltered, and of the disparities; all may be read `sample_guard` beyond their ends.
struct SampleRow {
  const float *reference, *target;
  const float* disparity;  ///< between the original images; NaN invalid, also beyond the ends
  int first;               ///< first column of the target
  int width;
  RowLine road;  ///< shifts of the perspective transformation
};

/// Filter a row of an image. Leaves the ends as they are: no sample is there.
void prefilter_row(const std::int16_t* row, int width, float* filtered);

/// Add the samples of every pixel and their products to the rows of sums, which are `pitch` apart and as long.
void add_samples(const SampleRow& row, std::ptrdiff_t pitch, float* sums);

}  // namespace roadstereo
