#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "roadstereo/matcher.hpp"
#include "stereo/cpu/rows.hpp"

namespace roadstereo::cpu {

/// Rows of numbers with padding on both sides, so that kernels may read beyond their ends. What they read there is
/// finite but has no meaning.
template <class T>
class PaddedRows {
 public:
  void resize(int rows, int width, int pad_left) {
    pitch_ = static_cast<std::size_t>(width) + static_cast<std::size_t>(pad_left) + row_padding;
    offset_ = static_cast<std::size_t>(pad_left);
    values_.resize(pitch_ * static_cast<std::size_t>(rows));
  }
  T* row(int r) { return values_.data() + offset_ + pitch_ * static_cast<std::size_t>(r); }
  const T* row(int r) const { return values_.data() + offset_ + pitch_ * static_cast<std::size_t>(r); }
  std::ptrdiff_t pitch() const { return static_cast<std::ptrdiff_t>(pitch_); }
  void clear() { std::fill(values_.begin(), values_.end(), T{}); }

 private:
  std::size_t pitch_ = 0;
  std::size_t offset_ = 0;
  std::vector<T> values_;
};

/// Computes the matching costs c(p, d) of eq. c row after row, from column sums that slide down the image. All sums are
/// whole numbers, so that a row's costs do not depend on where the slide began.
class CostRows {
 public:
  void prepare(const MatchInput& input, const MatcherOptions& options);

  /// Begins at row `v` with the columns [begin, end); `compute` is then called for v, v + 1, ….
  void start(int v, int begin, int end);

  /// Costs of row `v` for every disparity: plane d of `planes` begins at planes + d·plane_pitch, column 0.
  /// Pixels without a counterpart, and those of other columns, keep what was there.
  void compute(int v, float* planes, std::ptrdiff_t plane_pitch);

  /// Grey values of a row of either view, centred on mid-grey. Rows stay for 2·aggregation radius rows.
  const std::int16_t* reference_row(int v) const { return reference_.row(v % ring_); }
  const std::int16_t* target_row(int v) const { return target_.row(v % ring_); }
  int first_column(int v) const { return input_.first_column == nullptr ? 0 : input_.first_column[v]; }

 private:
  struct BorderColumn;

  int first_reference_column() const { return std::max(0, begin_ - radius_); }
  int first_target_column() const { return std::max(0, begin_ - radius_ - input_.disparities + 1); }
  int end_column() const { return std::min(width_, end_ + radius_); }

  void load(int v);
  void slide(int entering, int leaving);
  void slide_own_sums(int v, int sign);
  void compute_border(int v, int d, int from, int to, float* cost);
  BorderColumn border_column(int u, int d, int first_row, int last_row, int common_first) const;

  MatchInput input_;
  int width_ = 0;
  int height_ = 0;
  int radius_ = 0;
  int ring_ = 1;
  float noise_variance_ = 0;
  int begin_ = 0;  ///< columns that costs are wanted of
  int end_ = 0;
  int loaded_ = 0;  ///< rows below this are in the ring
  int first_entered_ = 0;
  PaddedRows<std::int16_t> reference_;  ///< ring of rows, grey minus mid-grey
  PaddedRows<std::int16_t> target_;     ///< the same; 0 where the transformed target has no image
  PaddedRows<std::int16_t> zero_;
  PaddedRows<std::int32_t> own_sums_;  ///< column sums: Σ i_ref, Σ i_ref², Σ i_tar, Σ i_tar², valid target rows
  PaddedRows<std::int32_t> products_;  ///< column sums of i_ref(u)·i_tar(u − d), a row per d
  PaddedRows<std::int32_t> statistics_;
  PaddedRows<float> deviations_;
  std::vector<BorderColumn> border_;
};

/// Sums over one column of a block, or over several, of the pixels that both views see.
struct CostRows::BorderColumn {
  std::int64_t pixels = 0;
  std::int64_t ref = 0, ref_ref = 0;
  std::int64_t tar = 0, tar_tar = 0;
  std::int64_t ref_tar = 0;

  BorderColumn& operator+=(const BorderColumn& other);
  BorderColumn operator-(const BorderColumn& other) const;
};

}  // namespace roadstereo::cpu
