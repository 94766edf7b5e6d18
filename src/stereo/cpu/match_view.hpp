#pragma once

#include <cstdint>
#include <span>

#include "core/mid_grey.hpp"
#include "roadstereo/matcher.hpp"

namespace roadstereo::cpu {

/// One view of a pair as the matcher walks over it. The matcher knows one direction only: pixel i of its own view may
/// match pixel i − d of the other. For the target view both images are therefore mirrored. The other view's rows are
/// stored backwards: column j holds pixel width − 1 − j, so own pixel i at disparity d meets column width − 1 − i + d.
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
