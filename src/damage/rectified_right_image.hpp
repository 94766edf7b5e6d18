#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Reads rows of the right image at the columns of a rectified pair.
class RectifiedRightImage {
 public:
  static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

  RectifiedRightImage(ImageView<const std::int16_t> image, const Misalignment& misalignment)
      : image_(image), misalignment_(misalignment), is_aligned_(misalignment.is_zero()) {}

  /// Row in which row v is found at column x.
  int row(double x, int v) const {
    if (is_aligned_) return v;
    const double row = std::clamp(v + misalignment_.rows_at(x, v), 0.0, image_.height() - 1.0);
    return static_cast<int>(row + 0.5);  // NOLINT(bugprone-incorrect-roundings): not negative, and lround is a call
  }
  /// Grey level at column x of row v, which is found in `row`; NaN outside.
  float operator()(double x, int v, int row) const {
    const double column = x + misalignment_.columns_at(v);
    if (!(column >= 0 && column < image_.width() - 1)) return unknown;
    const auto whole = static_cast<int>(column);
    const auto offset = static_cast<float>(column - whole);
    return interpolate(image_.row(row) + whole, offset);
  }
  /// Grey levels at the columns x, x + 1, … of row v, which is found in `row`; NaN outside.
  void read(double x, int v, int row, std::vector<float>& line) const {
    const double column = x + misalignment_.columns_at(v), whole = std::floor(column);
    const auto offset = static_cast<float>(column - whole);
    const int size = static_cast<int>(line.size()), left = static_cast<int>(whole);
    const int first = std::clamp(-left, 0, size), end = std::clamp(image_.width() - 1 - left, first, size);
    std::fill_n(line.begin(), first, unknown);
    std::fill(line.begin() + end, line.end(), unknown);
    const std::int16_t* const grey = image_.row(row);
    for (int k = first; k < end; ++k) line[static_cast<std::size_t>(k)] = interpolate(grey + left + k, offset);
  }

 private:
  static float interpolate(const std::int16_t* grey, float offset) {
    return (1 - offset) * static_cast<float>(grey[0]) + offset * static_cast<float>(grey[1]);
  }

  ImageView<const std::int16_t> image_;
  Misalignment misalignment_;
  bool is_aligned_;
};

}  // namespace roadstereo
