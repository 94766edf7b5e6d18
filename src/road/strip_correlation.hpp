#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// A block of an image without its mean.
struct CorrelationBlock {
  static constexpr int max_width = 15;
  static constexpr int max_height = 9;
  static constexpr int whole_vectors = 16;  ///< max_width up to whole vectors

  int width = 0;
  int height = 0;
  float deviation = 0;  ///< standard deviation of its grey levels
  std::array<float, std::size_t{max_width} * max_height + whole_vectors>
      values;  ///< row by row, `width` apart; what lies behind has no effect

  /// Cuts it out around (u, v), 2·half_width + 1 columns wide; the image must hold it whole.
  CorrelationBlock(ImageView<const std::int16_t> image, int u, int v, int half_width, int half_height);
};

/// Rows that are `pitch` apart, each with a guard behind it: a strip, or a part of longer rows.
struct StripView {
  const float* values;
  std::ptrdiff_t pitch;

  const float* row(int y) const { return values + y * pitch; }
};

/// As many rows of another image as the block has, each of columns that the block can begin at.
struct Strip {
  static constexpr int max_counts = 112;
  static constexpr int guard = 16;  ///< columns behind those that are compared; read, and without effect
  static constexpr int pitch = max_counts + CorrelationBlock::max_width + guard;

  std::array<float, static_cast<std::size_t>(pitch* CorrelationBlock::max_height)> values;

  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * pitch; }
  StripView view() const { return {values.data(), pitch}; }
};

/// One number for the part of a strip that begins at each column; the last `guard` mean nothing.
using StripValues = std::array<float, Strip::max_counts + Strip::guard>;

/// One over the standard deviation of a strip's part of `width` × `height` pixels that begins at each of `count`
/// columns; 0 where the deviation is below `min_deviation`. `inverse_deviations` has a guard behind them. The strip's
/// grey levels should lie around 0, so that rounding does not count.
void find_inverse_deviations(const StripView& strip, int width, int height, int count, float min_deviation,
                             float* inverse_deviations);

/// Normalised correlations at the first `count` columns; −1 where the inverse deviation is 0.
void correlate_strip(const CorrelationBlock& block, const StripView& strip, const float* inverse_deviations, int count,
                     StripValues& correlations);

/// Index of the first of the highest of `count` correlations.
int index_of_highest(const StripValues& correlations, int count);

inline constexpr int max_sampled = 32;  ///< columns that sample_strip fills at once

/// Fills a row of a strip with the grey levels of an image at the columns x + k·step, k from 0 to count − 1, minus
/// mid-grey, linear between the pixels. All of them must lie inside the row, `count` must be at
/// most max_sampled, and |1 − step| · count below 16.
void sample_strip(const std::int16_t* image_row, int image_width, double x, double step, int count, float* strip_row);

}  // namespace roadstereo
