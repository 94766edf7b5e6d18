#include "stereo/cpu/cost_rows.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::cpu {
namespace {

/// Subtracted from every grey value: keeps the sums of products in 32 bits and changes no covariance.
constexpr int mid_grey = grey_max / 2;

constexpr int no_row = -1;

enum OwnSum { ref_sum, ref_squares, tar_sum, tar_squares, tar_count, own_sum_count };
enum Statistic { sum_ref, mean_ref, residue_ref, sum_tar, mean_tar, residue_tar, statistic_count };

}  // namespace

CostRows::BorderColumn& CostRows::BorderColumn::operator+=(const BorderColumn& other) {
  pixels += other.pixels;
  ref += other.ref;
  ref_ref += other.ref_ref;
  tar += other.tar;
  tar_tar += other.tar_tar;
  ref_tar += other.ref_tar;
  return *this;
}

CostRows::BorderColumn CostRows::BorderColumn::operator-(const BorderColumn& other) const {
  return {pixels - other.pixels, ref - other.ref,         ref_ref - other.ref_ref,
          tar - other.tar,       tar_tar - other.tar_tar, ref_tar - other.ref_tar};
}

void CostRows::prepare(const MatchInput& input, const MatcherOptions& options) {
  input_ = input;
  width_ = input.reference.width();
  height_ = input.reference.height();
  radius_ = options.block_radius;
  ring_ = std::max(2 * options.aggregation_radius, radius_ + 1) + radius_ + 1;
  const double noise = options.texture_noise * grey_scale;
  noise_variance_ = static_cast<float>(noise * noise);
  const int padding = row_padding + input.disparities;
  reference_.resize(ring_, width_, padding);
  target_.resize(ring_, width_, padding);
  zero_.resize(1, width_, padding);
  zero_.clear();
  own_sums_.resize(own_sum_count, width_, padding);
  products_.resize(input.disparities, width_, row_padding);
  statistics_.resize(statistic_count, width_, padding);
  deviations_.resize(2, width_, padding);
  border_.resize(static_cast<std::size_t>(width_) + 1);
}

void CostRows::load(int v) {
  const std::int16_t* ref = input_.reference.row(v);
  const std::int16_t* tar = input_.target.row(v);
  std::int16_t* ref_row = reference_.row(v % ring_);
  std::int16_t* tar_row = target_.row(v % ring_);
  const int first = std::min(first_column(v), width_);
  const int end = end_column();
  for (int u = first_reference_column(); u < end; ++u) ref_row[u] = static_cast<std::int16_t>(ref[u] - mid_grey);
  for (int u = first_target_column(); u < end; ++u) {
    tar_row[u] = u < first ? std::int16_t{0} : static_cast<std::int16_t>(tar[u] - mid_grey);
  }
}

void CostRows::slide_own_sums(int v, int sign) {
  const std::int16_t* ref = reference_row(v);
  const std::int16_t* tar = target_row(v);
  const int end = end_column();
  const auto add = [&](const std::int16_t* row, int first, std::int32_t* sums, std::int32_t* squares) {
    for (int u = first; u < end; ++u) sums[u] += sign * row[u];
    for (int u = first; u < end; ++u) squares[u] += sign * row[u] * row[u];
  };
  add(ref, first_reference_column(), own_sums_.row(ref_sum), own_sums_.row(ref_squares));
  add(tar, first_target_column(), own_sums_.row(tar_sum), own_sums_.row(tar_squares));
  std::int32_t* count = own_sums_.row(tar_count);
  for (int u = std::max(first_column(v), first_target_column()); u < end; ++u) count[u] += sign;
}

/// Moves the column sums by one row; either row may be `no_row`.
void CostRows::slide(int entering, int leaving) {
  const auto ref = [&](int v) { return v == no_row ? zero_.row(0) : reference_row(v); };
  const auto tar = [&](int v) { return v == no_row ? zero_.row(0) : target_row(v); };
  if (entering != no_row) slide_own_sums(entering, 1);
  if (leaving != no_row) slide_own_sums(leaving, -1);
  for (int d = 0; d < input_.disparities; ++d) {
    slide_products(ref(entering), tar(entering) - d, ref(leaving), tar(leaving) - d, first_reference_column(),
                   end_column(), products_.row(d));
  }
}

void CostRows::start(int v, int begin, int end) {
  begin_ = begin;
  end_ = end;
  own_sums_.clear();
  products_.clear();
  first_entered_ = std::max(0, v - radius_);
  loaded_ = first_entered_;
}

void CostRows::compute(int v, float* planes, std::ptrdiff_t plane_pitch) {
  const int first_row = std::max(0, v - radius_);
  const int last_row = std::min(height_ - 1, v + radius_);
  int leaving = first_row > first_entered_ ? first_row - 1 : no_row;
  first_entered_ = first_row;
  for (; loaded_ <= last_row; ++loaded_) {
    load(loaded_);
    slide(loaded_, leaving);
    leaving = no_row;
  }
  if (leaving != no_row) slide(no_row, leaving);

  const int pixels = (last_row - first_row + 1) * (2 * radius_ + 1);
  const BlockStatisticsRow ref_row{statistics_.row(sum_ref), statistics_.row(mean_ref), statistics_.row(residue_ref),
                                   deviations_.row(0)};
  const BlockStatisticsRow tar_row{statistics_.row(sum_tar), statistics_.row(mean_tar), statistics_.row(residue_tar),
                                   deviations_.row(1)};
  block_statistics(own_sums_.row(ref_sum), own_sums_.row(ref_squares), radius_, pixels, noise_variance_, begin_, end_,
                   ref_row);
  block_statistics(own_sums_.row(tar_sum), own_sums_.row(tar_squares), radius_, pixels, noise_variance_,
                   std::max(0, begin_ - input_.disparities + 1), end_, tar_row);

  int common_first = 0;  // from this target column on, every row of the block is inside the target image
  for (int row = first_row; row <= last_row; ++row) common_first = std::max(common_first, first_column(row));
  for (int d = 0; d < input_.disparities; ++d) {
    float* cost = planes + d * plane_pitch;
    const int first = std::max(begin_, first_column(v) + d);
    const int last = std::min(end_, width_) - 1;
    const int full_first = std::max(first, common_first + d + radius_);
    const int full_last = std::min(last, width_ - 1 - radius_);
    if (full_first <= full_last) {
      const BlockStatistics ref{ref_row.sum, ref_row.mean, ref_row.residue, ref_row.inverse_deviation};
      const BlockStatistics tar{tar_row.sum - d, tar_row.mean - d, tar_row.residue - d, tar_row.inverse_deviation - d};
      correlation_row(products_.row(d), ref, tar, radius_, pixels, full_first, full_last, cost);
      compute_border(v, d, first, full_first - 1, cost);
      compute_border(v, d, full_last + 1, last, cost);
    } else {
      compute_border(v, d, first, last, cost);
    }
  }
}

/// The part of column u of the block rows that both views see at disparity d.
CostRows::BorderColumn CostRows::border_column(int u, int d, int first_row, int last_row, int common_first) const {
  const int x = u - d;
  if (x < 0) return {};
  BorderColumn column{own_sums_.row(tar_count)[x], own_sums_.row(ref_sum)[u],     own_sums_.row(ref_squares)[u],
                      own_sums_.row(tar_sum)[x],   own_sums_.row(tar_squares)[x], products_.row(d)[u]};
  if (x >= common_first) return column;
  column.ref = 0;
  column.ref_ref = 0;
  for (int row = first_row; row <= last_row; ++row) {
    if (x < first_column(row)) continue;
    const std::int64_t value = reference_row(row)[u];
    column.ref += value;
    column.ref_ref += value * value;
  }
  return column;
}

/// Costs of the pixels from … to, whose blocks are clipped to the common view.
void CostRows::compute_border(int v, int d, int from, int to, float* cost) {
  if (from > to) return;
  const int first_row = std::max(0, v - radius_);
  const int last_row = std::min(height_ - 1, v + radius_);
  int common_first = 0;
  for (int row = first_row; row <= last_row; ++row) common_first = std::max(common_first, first_column(row));
  const int first = std::max(0, from - radius_);
  const int last = std::min(width_ - 1, to + radius_);
  border_[0] = {};
  for (int u = first; u <= last; ++u) {
    const auto i = static_cast<std::size_t>(u - first);
    border_[i + 1] = border_[i];
    border_[i + 1] += border_column(u, d, first_row, last_row, common_first);
  }
  for (int u = from; u <= to; ++u) {
    const auto begin = static_cast<std::size_t>(std::max(first, u - radius_) - first);
    const auto end = static_cast<std::size_t>(std::min(last, u + radius_) - first);
    const BorderColumn block = border_[end + 1] - border_[begin];
    const auto n = static_cast<double>(block.pixels);
    const double variance_ref = static_cast<double>(block.pixels * block.ref_ref - block.ref * block.ref) / (n * n);
    const double variance_tar = static_cast<double>(block.pixels * block.tar_tar - block.tar * block.tar) / (n * n);
    const double covariance = static_cast<double>(block.pixels * block.ref_tar - block.ref * block.tar) / (n * n);
    const bool textured = variance_ref >= smallest_variance && variance_tar >= smallest_variance;
    const double deviations = std::sqrt((variance_ref + noise_variance_) * (variance_tar + noise_variance_));
    cost[u] = textured ? static_cast<float>(1 - covariance / deviations) : 1.0f;
  }
}

}  // namespace roadstereo::cpu
