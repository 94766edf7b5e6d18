#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Counts which disparities a coarse match found in each tile and leaves those to search there, with a margin. Damage
/// is far wider than its disparity is deep: a thing whose disparity leaves the margin is tens of pixels wide when it
/// belongs to the road, and cannot be missed.
class TileRanges {
 public:
  /// Counts the disparities of the coarse map (full-size pixels, NaN unknown) of a pair downsampled by `factor`.
  void find(const Image<float>& coarse, int factor, int width, int height, int disparities);

  const SearchRanges& ranges() const { return ranges_; }

 private:
  void count(const Image<float>& coarse, int factor);
  void choose(const std::vector<std::uint32_t>& counts, Image<SearchRange>& ranges, int factor, int disparities) const;

  std::size_t bins_ = 0;                                 ///< of one tile, one per disparity
  std::vector<std::uint32_t> in_reference_, in_target_;  ///< how often each disparity was seen in each tile
  SearchRanges ranges_;
};

}  // namespace roadstereo
