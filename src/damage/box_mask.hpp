#pragma once

#include <cstdint>

#include "damage/box.hpp"

namespace roadstereo {

/// A mask over the cells of a picture that is 0 outside a box, and holds no more than that. Columns and rows count from
/// the corner of the picture.
class BoxMask {
 public:
  BoxMask() = default;
  /// All cells are 0.
  explicit BoxMask(const Box& box) : BoxMask(box, Image<std::uint8_t>(box.columns(), box.rows(), 0)) {}
  /// `cells` has the size of the box.
  BoxMask(const Box& box, Image<std::uint8_t> cells) : box_(box), cells_(std::move(cells)) {}

  const Box& box() const { return box_; }
  /// The cells of the box, from its own corner on.
  Image<std::uint8_t>& cells() { return cells_; }
  const Image<std::uint8_t>& cells() const { return cells_; }

  /// Whether any cell of the picture is set, be it inside the box or not.
  bool operator()(int column, int row) const {
    return box_.contains(column, row) && cells_(column - box_.first_column, row - box_.first_row) != 0;
  }
  /// The cell must lie in the box.
  void set(int column, int row, bool value = true) {
    cells_(column - box_.first_column, row - box_.first_row) = value ? 255 : 0;
  }

  /// What of it lies in another box.
  BoxMask within(const Box& box) const;

 private:
  Box box_;
  Image<std::uint8_t> cells_;
};

}  // namespace roadstereo
