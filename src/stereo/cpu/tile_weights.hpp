#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stereo/cpu/match_view.hpp"
#include "stereo/cpu/padded_rows.hpp"
#include "stereo/window.hpp"

namespace roadstereo::cpu {

/// The weights ω of the matched pixels of one view in a tile of columns, row after row. ω(p, q) = ω(q, p): only the
/// taps behind the pixel are computed, those before it were computed as its neighbours' taps. Rows and columns are
/// counted in matched pixels.
class TileWeights {
 public:
  /// Memory for tiles of up to `columns` columns.
  void prepare(int columns, const MatcherOptions& options, std::span<const Tap> taps);

  /// Begins at row `y`; `compute` is then called for y, y + 1, …. Weights are wanted of `columns` columns from `first`.
  void start(const MatchView& view, int y, int first, int columns);

  /// The weights of row y: for every tap whose row lies in the image, row by row, a row of numbers by the column of the
  /// tile. They live until the next call. Taps outside the image have weights of no meaning.
  std::span<const float* const> compute(int y);

 private:
  int rows() const { return (view_->height() + pixel_step_ - 1) / pixel_step_; }
  void compute_behind(int y);
  const float* grey_row(int y);

  const MatchView* view_ = nullptr;
  int pixel_step_ = 1;
  int radius_ = 0;
  int ring_ = 1;
  int first_ = 0;    ///< column 0 in memory
  int columns_ = 0;  ///< the tile and twice the radius on either side
  int loaded_ = 0;   ///< rows below this are in the ring of grey values
  int computed_ = 0;
  float log2_colour_ = 0;
  std::vector<Tap> taps_;  ///< in matched pixels
  std::vector<float> log2_space_;
  PaddedRows<std::int16_t> samples_;
  PaddedRows<float> grey_;     ///< ring of rows
  PaddedRows<float> weights_;  ///< ring of rows, each a row of numbers for every tap behind the pixel
  PaddedRows<float> centre_;   ///< ω(p, p) = 1
  std::vector<const float*> row_;
};

}  // namespace roadstereo::cpu
