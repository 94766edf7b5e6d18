#include "stereo/cpu/tile_costs.hpp"

#include <algorithm>

#include "core/block_row_radius.hpp"

namespace roadstereo::cpu {
namespace {

constexpr int none = -1;

/// Rows of whole numbers that each view has.
enum Integers {
  column_sum,
  column_square,
  sample_pairs,
  block_sum,
  block_mean,
  running_sum,
  running_square,
  integer_rows
};

/// Rows of other numbers.
enum Numbers { block_residue, block_deviation, number_rows };

}  // namespace

void TileCosts::prepare(int columns, int disparities, const MatcherOptions& options) {
  const std::ptrdiff_t pitch = padded_disparities(disparities);
  radius_ = options.block_radius;
  row_radius_ = block_row_radius(options);
  pixel_step_ = options.pixel_step;
  ring_ = 2 * row_radius_ + 2;
  const double noise = options.ncc_noise_sigma * grey_scale;
  noise_variance_ = static_cast<float>(noise * noise);
  const std::ptrdiff_t own_columns = std::ptrdiff_t{columns} * pixel_step_ + std::ptrdiff_t{2} * radius_;
  const std::ptrdiff_t other_columns = own_columns + pitch + radius_;
  for (const View view : {own, other}) {
    const std::ptrdiff_t width = view == own ? own_columns : other_columns;
    views_[view].grey.resize(static_cast<std::size_t>(ring_), 0, width);
    views_[view].integers.resize(integer_rows, 0, width + 1);
    views_[view].numbers.resize(number_rows, 0, width);
  }
  no_row_.resize(1, 0, other_columns);
  products_.resize(1, 0, own_columns * pitch);
}

ColumnSums TileCosts::sums(View view) {
  return {views_[view].integers.row(column_sum), views_[view].integers.row(column_square)};
}

BlockStatistics TileCosts::statistics(View view) {
  OneView& of = views_[view];
  return {of.integers.row(block_sum), of.integers.row(block_mean), of.numbers.row(block_residue),
          of.numbers.row(block_deviation)};
}

void TileCosts::start(const MatchView& view, int v, int first, int columns, const DisparityRange& range) {
  view_ = &view;
  range_ = range;
  pitch_ = padded_disparities(range.count);
  first_ = first - radius_;
  columns_ = (columns - 1) * pixel_step_ + 1 + 2 * radius_;
  other_first_ = view.width() - first_ - columns_ + range.first;
  other_columns_ = columns_ + static_cast<int>(pitch_) + radius_;
  oldest_ = entered_ = std::max(0, v - row_radius_);
  for (const View side : {own, other}) views_[side].integers.clear();
  products_.clear();
}

/// Moves the column sums by one row; either row may be `none`.
void TileCosts::slide(int entering, int leaving) {
  const auto row_of = [&](View view, int v) {
    return v == none ? no_row_.row(0) : views_[view].grey.row(static_cast<std::size_t>(v % ring_));
  };
  if (entering != none) {
    view_->copy_own(entering, first_, columns_, row_of(own, entering));
    view_->copy_other(entering, other_first_, other_columns_, row_of(other, entering));
  }
  SamplePair* own_pairs = views_[own].integers.row(sample_pairs);
  SamplePair* other_pairs = views_[other].integers.row(sample_pairs);
  slide_sums(row_of(own, entering), row_of(own, leaving), 0, columns_, 1, sums(own), own_pairs);
  slide_sums(row_of(other, entering), row_of(other, leaving), 0, other_columns_, -1, sums(other), other_pairs);
  slide_products(own_pairs, other_pairs, columns_ - 1, 0, columns_, range_.count, pitch_, products_.row(0));
}

/// The running sums that clipped blocks are taken from.
void TileCosts::sum_running(int v) {
  const auto run = [](const std::int32_t* values, int count, int end, std::int32_t* running) {
    std::uint32_t total = 0;  // may wrap; the differences that matter are small
    for (int k = 0; k <= count; ++k) {
      running[k] = static_cast<std::int32_t>(total);
      if (k < end) total += static_cast<std::uint32_t>(values[k]);
    }
  };
  for (const View view : {own, other}) {
    const ColumnSums columns = sums(view);
    const int count = view == own ? columns_ : other_columns_;
    const int end = view == own ? count : view_->end_visible(v) - other_first_;
    run(columns.sum, count, end, views_[view].integers.row(running_sum));
    run(columns.square, count, end, views_[view].integers.row(running_square));
  }
}

void TileCosts::compute(int v, float* costs) {
  const int height = view_->height();
  const int first_row = std::max(0, v - row_radius_);
  const int last_row = std::min(height - 1, v + row_radius_);
  while (entered_ <= last_row || oldest_ < first_row) {
    slide(entered_ <= last_row ? entered_++ : none, oldest_ < first_row ? oldest_++ : none);
  }

  const int block_rows = last_row - first_row + 1;
  const int pixels = block_rows * (2 * radius_ + 1);
  block_statistics(sums(own), radius_, pixels, noise_variance_, radius_, columns_ - radius_, statistics(own));
  block_statistics(sums(other), radius_, pixels, noise_variance_, radius_, other_columns_ - radius_, statistics(other));
  const CostRow row{.first = std::max(radius_, -first_),
                    .end = std::min(columns_ - radius_, view_->width() - first_),
                    .step = pixel_step_,
                    .first_visible = view_->first_visible(v) + range_.first - first_,
                    .last_valid = view_->last_valid(v) - first_,
                    .block_radius = radius_,
                    .block_rows = block_rows,
                    .disparities = range_.count,
                    .pitch = pitch_,
                    .origin = columns_ - 1,
                    .noise_variance = noise_variance_,
                    .products = products_.row(0),
                    .own = statistics(own),
                    .other = statistics(other)};
  full_block_costs(row, costs);
  const bool clipped_left = row.first < row.first_visible + range_.count - 1 + radius_;
  const bool clipped_right = row.end + radius_ > row.last_valid + 1;
  if (!clipped_left && !clipped_right) return;
  sum_running(v);
  clipped_block_costs(row,
                      {.own_sum = views_[own].integers.row(running_sum),
                       .own_square = views_[own].integers.row(running_square),
                       .other_sum = views_[other].integers.row(running_sum),
                       .other_square = views_[other].integers.row(running_square)},
                      costs);
}

}  // namespace roadstereo::cpu
