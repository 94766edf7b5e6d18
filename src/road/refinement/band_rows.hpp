#pragma once

#include <algorithm>
#include <cstddef>

#include "road/refinement/measured.hpp"
#include "road/refinement/settings.hpp"
#include "road/refinement/weighted_mean.hpp"
#include "road/row_shift.hpp"

namespace roadstereo {

/// What is refined, and how.
struct RefinementInput {
  ImageView<const float> disparity, variance;
  DisparityPlane road;
  RefinementOptions options;
};

/// The rows of a band and those around them as the kernels read them: heights above the road with room on both sides.
class BandRows {
 public:
  static constexpr int band = 32;   ///< rows
  static constexpr int lanes = 16;  ///< elements that a kernel may touch behind a row

  BandRows(const RefinementInput& maps, int reach)
      : maps_(maps), reach_(reach), pitch_(pitch(maps.disparity.width(), reach)) {}

  static std::ptrdiff_t pitch(int width, int reach) { return width + 2 * std::ptrdiff_t{reach} + lanes; }
  static std::size_t numbers(int width, int reach) {
    return static_cast<std::size_t>(3 * pitch(width, reach) * (band + 2 * std::ptrdiff_t{reach}));
  }

  void fill(int first, int last, float* numbers) {
    first_ = std::max(0, first - reach_);
    end_ = std::min(maps_.disparity.height(), last + reach_);
    numbers_ = numbers;
    for (int v = first_; v < end_; ++v) fill_row(v);
  }

  int first() const { return first_; }
  int end() const { return end_; }
  bool holds(int v) const { return v >= first_ && v < end_; }
  MeasuredRow row(int v) const {
    const float* at = numbers_ + 3 * pitch_ * (v - first_) + reach_;
    return {at, at + pitch_, at + 2 * pitch_};
  }

 private:
  void fill_row(int v) {
    const float *disparity = maps_.disparity.row(v), *variance = maps_.variance.row(v);
    const VarianceBounds bounds = variance_bounds(maps_.options);
    const RowLine road = row_line(maps_.road, v, 0);
    float* height = numbers_ + 3 * pitch_ * (v - first_);
    float *precision = height + pitch_, *spread = precision + pitch_;
    const int width = maps_.disparity.width();
    const MeasuredHeight unknown = not_measured();
    const auto fill_sides = [&](float* row, float value) {
      std::fill_n(row, reach_, value);
      std::fill(row + reach_ + width, row + pitch_, value);
    };
    fill_sides(height, unknown.value);
    fill_sides(precision, unknown.precision);
    fill_sides(spread, unknown.variance);
    for (int u = 0; u < width; ++u) {
      const MeasuredHeight pixel = measured(disparity[u], variance[u], road.at(static_cast<float>(u)), bounds);
      height[reach_ + u] = pixel.value;
      precision[reach_ + u] = pixel.precision;
      spread[reach_ + u] = pixel.variance;
    }
  }

  const RefinementInput& maps_;
  int reach_;
  std::ptrdiff_t pitch_;
  int first_ = 0, end_ = 0;
  float* numbers_ = nullptr;
};

}  // namespace roadstereo
