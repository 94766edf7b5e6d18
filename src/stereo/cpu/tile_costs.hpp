#pragma once

#include <cstdint>

#include "stereo/cpu/block_costs.hpp"
#include "stereo/cpu/match_view.hpp"
#include "stereo/cpu/padded_rows.hpp"

namespace roadstereo::cpu {

/// Disparities first ≤ d < first + count.
struct DisparityRange {
  int first = 0;
  int count = 0;
};

/// Computes the matching costs of the matched pixels of one view in a tile of columns, row after row, from column sums
/// that slide down the image. All sums are whole numbers, so that a row's costs do not depend on where the slide began.
class TileCosts {
 public:
  /// Memory for tiles of up to `columns` columns and `disparities` disparities.
  void prepare(int columns, int disparities, const MatcherOptions& options);

  /// Begins at row `v`; `compute` is then called for v, v + 1, … or, with a pixel_step of 2, v, v + 2, …. Costs are
  /// wanted of `columns` matched columns from the image's column `first` on, which may lie outside, and of the
  /// disparities of `range`.
  void start(const MatchView& view, int v, int first, int columns, const DisparityRange& range);

  /// Costs of row v at the columns that lie in the image: matched column k of the tile begins at costs + k·pitch, with
  /// the first disparity of the range. Disparities without a counterpart get 0.
  void compute(int v, float* costs);

  /// Elements from one column to the next: the disparities, padded for vectors.
  std::ptrdiff_t pitch() const { return pitch_; }

 private:
  enum View { own, other };
  struct OneView {
    PaddedRows<std::int16_t> grey;  ///< ring of rows
    PaddedRows<std::int32_t> integers;
    PaddedRows<float> numbers;
  };

  void slide(int entering, int leaving);
  void sum_running(int v);
  ColumnSums sums(View view);
  BlockStatistics statistics(View view);

  const MatchView* view_ = nullptr;
  DisparityRange range_;
  std::ptrdiff_t pitch_ = 0;
  int radius_ = 0, row_radius_ = 0;  ///< of the block, along rows and columns
  int pixel_step_ = 1;
  int ring_ = 1;
  float noise_variance_ = 0;
  // Tile coordinates: own column 0 is image column first_, other column 0 is column other_first_ of the backward row.
  int first_ = 0;
  int columns_ = 0;  ///< own columns in memory: the tile and a block's radius on either side
  int other_first_ = 0;
  int other_columns_ = 0;
  int entered_ = 0;  ///< rows below this are in the sums, from `oldest_` on
  int oldest_ = 0;
  OneView views_[2];
  PaddedRows<std::int16_t> no_row_;
  PaddedRows<std::int32_t> products_;  ///< column sums of own·other, pitch_ elements a column
};

}  // namespace roadstereo::cpu
