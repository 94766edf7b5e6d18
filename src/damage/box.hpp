#pragma once

#include <algorithm>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// First and last column and row, both inside.
struct Box {
  int first_column = 0, first_row = 0, last_column = -1, last_row = -1;

  bool empty() const { return last_column < first_column; }
  int columns() const { return last_column - first_column + 1; }
  int rows() const { return last_row - first_row + 1; }
  bool contains(int column, int row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
  void add(int column, int row) { add_run(row, column, column); }
  /// The cells of a row from one column to another, both inside.
  void add_run(int row, int first, int last) {
    if (empty()) {
      *this = {first, row, last, row};
      return;
    }
    first_column = std::min(first_column, first);
    first_row = std::min(first_row, row);
    last_column = std::max(last_column, last);
    last_row = std::max(last_row, row);
  }
  /// Within an image of that size.
  Box grown(int by, int width, int height) const {
    return {std::max(0, first_column - by), std::max(0, first_row - by), std::min(width - 1, last_column + by),
            std::min(height - 1, last_row + by)};
  }
};

/// The box of a whole image.
template <class Value>
Box whole(const Image<Value>& image) {
  return {0, 0, image.width() - 1, image.height() - 1};
}

}  // namespace roadstereo
