#pragma once

#include <vector>

#include "damage/cells.hpp"

namespace roadstereo {

/// Cells whose road both cameras see: those from some column of each row on. Left of it the match of the road lies
/// outside the right image, which ends the view as the border of the left image does. So does a mask.
class CommonView {
 public:
  /// All cells without a mask, and without a right image or the plane of the road.
  CommonView(const DamageInput& input, const Cells& cells);

  /// First column of a row in view but for the mask; the number of columns if there is none.
  int first_column(int row) const { return first_columns_[static_cast<std::size_t>(row)]; }
  bool contains(int i, int j) const { return i >= first_column(j) && (masked_.empty() || masked_(i, j) == 0); }
  /// Whether one of the four neighbours of a cell in view is outside.
  bool is_on_border(int i, int j) const {
    return is_outside(i - 1, j) || is_outside(i + 1, j) || is_outside(i, j - 1) || is_outside(i, j + 1);
  }
  /// Whether a cell in view is the first or the last of its row.
  bool is_at_side(int i, int j) const { return i == first_column(j) || i + 1 == columns_; }
  /// Set the cells of a mask outside the view to 255.
  void fill_outside(Image<std::uint8_t>& mask) const;
  /// Set the masked cells of a mask to 255.
  void fill_masked(Image<std::uint8_t>& mask) const;
  /// Remove the measurements outside: what is matched there is not the road, but an accident in what is left of the
  /// search range.
  void remove_outside(Cells& cells) const;

 private:
  void mark_masked(ImageView<const std::uint8_t> mask, const Cells& cells);
  bool is_outside(int i, int j) const {
    return i < 0 || j < 0 || i >= columns_ || j >= static_cast<int>(first_columns_.size()) || !contains(i, j);
  }

  int columns_;
  Image<std::uint8_t> masked_;      ///< not 0 where a pixel of the cell is masked; empty: none
  std::vector<int> first_columns_;  ///< by row; `columns_` where there is none
};

}  // namespace roadstereo
