#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/matcher.hpp"
#include "stereo/coarse/tile_range.hpp"

namespace roadstereo {

/// Disparity range of each tile from the histogram of the coarse map, with a margin. Damage is much wider than its
/// disparity is deep: a part of the road that leaves the margin is tens of pixels wide, and not missed.
class TileRanges {
 public:
  /// Counts the disparities of the coarse map (full-size pixels, NaN unknown) of a pair downsampled by `factor`.
  void find(const Image<float>& coarse, int factor, int width, int height, int disparities, int threads);

  const SearchRanges& ranges() const { return ranges_; }

 private:
  void count(const Image<float>& coarse, int factor, int threads);
  void count_row(const float* row, int width, int factor, std::size_t counts);
  void choose(const std::vector<std::uint32_t>& counts, Image<SearchRange>& ranges, int factor, int disparities) const;

  std::size_t bins_ = 0;                                 ///< of the histogram of a tile
  std::vector<std::uint32_t> in_reference_, in_target_;  ///< histograms of the tiles
  std::vector<TileSpan> columns_;                        ///< tiles of every column of the coarse map
  SearchRanges ranges_;
};

}  // namespace roadstereo
