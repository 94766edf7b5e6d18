#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Finds, before matching, which disparities each tile of a pair can have: matches the pair at a quarter of its size
/// and takes what was seen there, with a margin. Damage is far wider than its disparity is deep: a thing whose
/// disparity leaves the margin is tens of pixels wide when it belongs to the road, and cannot be missed.
/// Holds its memory from frame to frame.
class RangeSearch {
 public:
  RangeSearch(const std::string& engine, int threads);

  /// The ranges of this pair, valid until the next call; null when the search would not pay.
  const SearchRanges* find(const MatchInput& input);

 private:
  void shrink_pair(const MatchInput& input);
  void count_disparities();
  void choose(const std::vector<std::uint32_t>& counts, Image<SearchRanges::Range>& ranges, int disparities) const;

  std::unique_ptr<StereoEngine> engine_;
  GreyImage reference_, target_;
  std::vector<int> first_column_;
  MatchMaps maps_;
  std::size_t bins_ = 0;                                 ///< of one tile, one per disparity
  std::vector<std::uint32_t> in_reference_, in_target_;  ///< how often each disparity was seen in each tile
  SearchRanges ranges_;
};

}  // namespace roadstereo
