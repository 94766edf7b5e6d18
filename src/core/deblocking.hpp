#pragma once

#include <cmath>
#include <cstdint>

#include "roadstereo/grey_scale.hpp"
#include "roadstereo/host_device.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Side of the blocks of JPEG, pixels.
inline constexpr int jpeg_block = 8;

/// Where steps between blocks are measured: one row and one column of three, so that they lie everywhere in the blocks.
struct BlockStepSamples {
  static constexpr int step = 3;
  int rows = 0, borders_across = 0;  ///< rows, from the second on, and the borders that each of them crosses
  int columns = 0, borders_down = 0;

  BlockStepSamples(int width, int height)
      : rows((height + step - 2) / step),
        borders_across(width < 2 ? 0 : (width - 2) / jpeg_block),
        columns((width + step - 1) / step),
        borders_down(height < 2 ? 0 : (height - 2) / jpeg_block) {}
  ROADSTEREO_HD int across() const { return rows * borders_across; }
  ROADSTEREO_HD int count() const { return across() + columns * borders_down; }
};

/// Sums of absolute steps at the borders of blocks, and on both sides beside them.
struct BlockSteps {
  std::int64_t between = 0, beside = 0;

  /// Excess of the former over the latter, relative; 0 without any.
  ROADSTEREO_HD double excess() const {
    return beside > 0 ? 2 * static_cast<double>(between) / static_cast<double>(beside) - 1 : 0;
  }
};

/// Strength of the filter, the mean excess of a step in grey values, of `count` steps; 0 for images that are not
/// compressed, whose excess is −0.03 to 0.02, and more by chance where the steps are few.
ROADSTEREO_HD inline int deblocking_strength(const BlockSteps& steps, int count) {
  constexpr double min_excess = 0.05, min_sigmas = 3;
  if (count == 0 || steps.excess() < min_excess + min_sigmas / std::sqrt(static_cast<double>(count))) return 0;
  return static_cast<int>((2 * steps.between - steps.beside + count) / (std::int64_t{2} * count));
}

ROADSTEREO_HD inline int absolute(int value) {
  return value < 0 ? -value : value;
}

/// Adds the steps at the border before c of four pixels in line.
ROADSTEREO_HD inline void add_steps(int a, int b, int c, int d, int& between, int& beside) {
  between += absolute(c - b);
  beside += absolute(b - a) + absolute(d - c);
}

/// Smooths the step between b and c of four pixels in line (H.263, annex J): most where it is as large as `strength`,
/// not at all from twice that on, since such a step belongs to the picture.
ROADSTEREO_HD inline void smooth_step(std::int16_t& a, std::int16_t& b, std::int16_t& c, std::int16_t& d,
                                      int strength) {
  const auto least = [](int one, int other) { return one < other ? one : other; };
  const auto clamp = [least](int value, int limit) { return value < -limit ? -limit : least(value, limit); };
  const auto level = [least](int value) { return static_cast<std::int16_t>(value < 0 ? 0 : least(value, grey_max)); };
  const int step = (a - 4 * b + 4 * c - d) / 8, size = absolute(step);
  const int change = size <= strength ? size : 2 * strength - size;
  if (change <= 0) return;
  const int inner = step < 0 ? -change : change, outer = clamp((a - d) / 4, change / 2);
  a = level(a - outer);
  b = level(b + inner);
  c = level(c - inner);
  d = level(d + outer);
}

/// Measures the steps between the blocks of 8×8 pixels that JPEG quantises apart.
BlockSteps measure_block_steps(ImageView<const std::int16_t> image);

/// Smooths them: those along the rows, then those down the columns.
void smooth_block_steps(ImageView<std::int16_t> image, int strength);

}  // namespace roadstereo
