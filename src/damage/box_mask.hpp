#pragma once

#include <cstddef>
#include <cstdint>

#include "damage/cell_box.hpp"

namespace roadstereo {

/// Mask over the cells of an image that stores only a box; cells outside the box are 0. Columns and rows are those of
/// the image.
class BoxMask {
 public:
  BoxMask() = default;
  /// All cells are 0.
  explicit BoxMask(const CellBox& box) : BoxMask(box, Image<std::uint8_t>(box.columns(), box.rows(), 0)) {}
  /// `cells` has the size of the box.
  BoxMask(const CellBox& box, Image<std::uint8_t> cells) : box_(box), cells_(std::move(cells)) {}

  const CellBox& box() const { return box_; }
  /// Cells of the box; (0, 0) is its first column and row.
  Image<std::uint8_t>& cells() { return cells_; }
  const Image<std::uint8_t>& cells() const { return cells_; }

  /// Whether a cell of the image is set; cells outside the box are not.
  bool operator()(int column, int row) const {
    return box_.contains(column, row) && cells_(column - box_.first_column, row - box_.first_row) != 0;
  }
  /// Set a cell of the box.
  void set(int column, int row, bool value = true) {
    cells_(column - box_.first_column, row - box_.first_row) = value ? 255 : 0;
  }

  /// The same mask stored in another box; cells outside both boxes are 0.
  BoxMask cropped(const CellBox& box) const;

 private:
  CellBox box_;
  Image<std::uint8_t> cells_;
};

/// Number of cells that are set.
std::size_t cell_count(const BoxMask& mask);

}  // namespace roadstereo
