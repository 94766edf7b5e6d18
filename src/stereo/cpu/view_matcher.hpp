#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stereo/cpu/aggregation.hpp"
#include "stereo/cpu/match_view.hpp"
#include "stereo/cpu/padded_rows.hpp"
#include "stereo/cpu/tile_costs.hpp"
#include "stereo/cpu/tile_weights.hpp"

namespace roadstereo::cpu {

/// Tile of a view: rows [first_row, last_row), columns [first, end) in the order of the matcher, and the disparities to
/// search. Its first row and column are matched ones.
struct Tile {
  int first_row, last_row;
  int first, end;
  DisparityRange range;
};

/// Matches one view tile by tile. Owns the scratch memory of one thread: a ring of cost rows as high as the aggregation
/// window and as wide as a tile (drawing in match_view.hpp), no volume. Rows y and columns within a tile are counted in
/// matched pixels.
class ViewMatcher {
 public:
  /// Returns the pixels across a tile, whole strips of matched ones: the ring of costs stays in the cache of a core.
  static int tile_columns(int disparities, const MatcherOptions& options);

  /// Allocates memory for tiles of up to `columns` pixels across.
  void prepare(int columns, int disparities, const MatcherOptions& options, std::span<const Tap> taps);

  /// Sets weight and truncation of the prior.
  void set_prior(const MatcherOptions& options);

  /// Writes the winners of a tile of the view into `maps`, for the reference view also their variances and sub-pixel
  /// offsets.
  void match(const MatchView& view, const Tile& tile, MatchMaps& maps, Image<float>& offset);

 private:
  int matched(int pixels) const { return (pixels + pixel_step_ - 1) / pixel_step_; }
  PriorRow prior_row(const MatchView& view, int y, const Tile& tile);
  void match_row(const MatchView& view, int y, const Tile& tile, MatchMaps& maps, Image<float>& offset);
  int& half_width(int dv) {
    const int row = dv + rows_;
    return half_widths_[static_cast<std::size_t>(row)];
  }
  float* cost_row(int y) { return costs_.row(static_cast<std::size_t>(y % ring_)); }

  int pixel_step_ = 1;
  int radius_ = 0;  ///< of the window, columns
  int rows_ = 0;    ///< of the window, rows to either side
  int ring_ = 1;
  int step_ = 1;
  std::vector<int> half_widths_;  ///< of the window's rows, in steps
  TileCosts tile_costs_;
  TileWeights tile_weights_;
  PaddedRows<float> costs_;  ///< ring of rows; column 0 is the tile's first
  std::vector<WindowRow> window_;
  PaddedRows<float> scratch_;
  std::vector<const float*> steps_;
  float effective_samples_ = 1, peak_floor_ = 0;
  float prior_weight_ = 0, prior_truncation_px_ = 0;
  std::vector<float> prior_low_, prior_high_;
  std::vector<std::int16_t> winner_;
  std::vector<float> offset_, variance_;
};

}  // namespace roadstereo::cpu
