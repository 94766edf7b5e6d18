#pragma once

#include <algorithm>
#include <cstddef>

#include "road/refinement/band_rows.hpp"
#include "road/refinement/row_slopes.hpp"

namespace roadstereo {

/// The slopes of a band's rows: from the means of boxes, and these from sums over columns.
class BandSlopes {
 public:
  BandSlopes(const SlopeSettings& settings, int width)
      : settings_(settings), width_(width), pitch_(BandRows::pitch(width, settings.step)) {}

  static std::size_t numbers(const SlopeSettings& settings, int width) {
    const std::ptrdiff_t pitch = BandRows::pitch(width, settings.step), step = settings.step;
    const std::ptrdiff_t sums = BandRows::band + 2 * (2 * step - 1), boxes = BandRows::band + 2 * step;
    return static_cast<std::size_t>(pitch * (2 * sums + 2 * boxes + 2));
  }

  void fill(const BandRows& rows, int first, int last, float* numbers) {
    const int step = settings_.step, sums = BandRows::band + 2 * (2 * step - 1);
    numbers_ = numbers + 2 * pitch_ * sums;
    top_ = first - step;
    const int first_sum = std::max(first - 2 * step + 1, rows.first());
    const int end_sum = std::min(last + 2 * step - 1, rows.end());
    for (int v = first_sum; v < end_sum; ++v) {
      const MeasuredRow row = rows.row(v);
      sum_columns({row.value, row.precision}, step - 1, -step, width_ + step, sums_of(numbers, v - first_sum));
    }
    for (int v = top_; v < last + step; ++v) {
      const int from = std::max(v - step + 1, first_sum), to = std::min(v + step, end_sum);
      mean_of_rows(sums_of(numbers, from - first_sum), 2 * pitch_, to - from, -step, width_ + step, box_row(v));
    }
  }

  /// Writes behind the boxes: the slopes of one row at a time.
  SlopeRow row(const float* heights, int v) {
    const std::ptrdiff_t boxes = BandRows::band + 2 * std::ptrdiff_t{settings_.step};
    float *const across = numbers_ + 2 * pitch_ * boxes, *const down = across + pitch_;
    row_slopes(heights, {box_row(v), box_row(v - settings_.step), box_row(v + settings_.step)}, settings_, width_,
               across, down);
    return {across, down};
  }

 private:
  BoxRow sums_of(float* numbers, int index) const {
    float* const at = numbers + 2 * pitch_ * index + settings_.step;
    return {at, at + pitch_};
  }
  BoxRow box_row(int v) const { return sums_of(numbers_, v - top_); }

  SlopeSettings settings_;
  int width_;
  std::ptrdiff_t pitch_;
  float* numbers_ = nullptr;  ///< of the boxes
  int top_ = 0;               ///< row of the first boxes
};

}  // namespace roadstereo
