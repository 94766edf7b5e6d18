#pragma once

#include <cstdint>
#include <span>

#include "core/mid_grey.hpp"
#include "roadstereo/matcher.hpp"

namespace roadstereo::cpu {

// How a matcher walks over a view, on the host and on a device (stereo/cuda/match_view/tile.hpp):
//
//   tile with its halo, in a view                     ring of cost rows (host), window of 2·rows + 1 rows
//   +---------------------------------------+
//   | r, r' of a block: read for the blocks |         v − rows  | oldest: overwritten by row v + rows + 1
//   |   +-------------------------------+   |            …      |
//   |   | R = taps: costs are computed  |   |            v      | row whose pixels are aggregated
//   |   |   +-----------------------+   |   |            …      |
//   |   |   | tile: pixels to match |   |   |         v + rows  | newest
//   |   |   +-----------------------+   |   |
//   |   +-------------------------------+   |         Row q lies at ring row q mod (2·rows + 1).
//   +---------------------------------------+         A device keeps the tile with R and R' in shared memory.
//
//   columns of either view, width w                   the common view in row v
//   own:    0    1   …   i   …          w − 1         own pixel i has a counterpart at disparity d
//                        | d = 0, 1, 2, …               where  first_visible(v) ≤ i − d  and  i ≤ last_valid(v):
//   other:  w−1      …   w−1−i  w−i  …      0         reference: first_visible = first_column[v], last_valid = w − 1
//           (backward: counterparts lie one           target (both images mirrored): first_visible = 0,
//            behind the other)                                          last_valid = w − 1 − first_column[v]

/// View of a pair as the matcher walks over it. The matcher knows one direction only: pixel i of its own view may match
/// pixel i − d of the other. For the target view both images are therefore mirrored. The rows of the other view are
/// stored backward: column j holds pixel width − 1 − j, so that own pixel i at disparity d meets column
/// width − 1 − i + d.
class MatchView {
 public:
  enum Side { reference, target };

  /// `first_column[v]`: from there on, every row of the block around row v is inside the target image.
  MatchView(const MatchInput& input, Side side, std::span<const int> first_column)
      : input_(&input), side_(side), first_column_(first_column) {}

  Side side() const { return side_; }
  int width() const { return input_->reference.width(); }
  int height() const { return input_->reference.height(); }

  /// Prior of winner-take-all in this view; empty: none.
  DisparityPriorView prior() const { return side_ == reference ? input_->prior : DisparityPriorView{}; }

  /// Own pixel i of row v sees the other view from disparity 0 to i − first_visible(v).
  int first_visible(int v) const { return side_ == reference ? first_column(v) : 0; }
  /// Last own pixel of row v that lies inside the view.
  int last_valid(int v) const { return side_ == reference ? width() - 1 : width() - 1 - first_column(v); }
  /// One past the last column of the other view's backward row v that lies inside it.
  int end_visible(int v) const { return width() - first_visible(v); }

  /// Writes the columns first … first + count − 1 of row v, grey values minus mid-grey; 0 outside the image.
  void copy_own(int v, int first, int count, std::int16_t* out) const;
  void copy_other(int v, int first, int count, std::int16_t* out) const;

 private:
  int first_column(int v) const { return first_column_[static_cast<std::size_t>(v)]; }

  const MatchInput* input_;
  Side side_;
  std::span<const int> first_column_;
};

}  // namespace roadstereo::cpu
