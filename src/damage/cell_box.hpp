#pragma once

#include <algorithm>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Rectangle of cells; the last column and row are inside. Empty by default.
struct CellBox {
  int first_column = 0, first_row = 0, last_column = -1, last_row = -1;

  bool empty() const { return last_column < first_column; }
  int columns() const { return last_column - first_column + 1; }
  int rows() const { return last_row - first_row + 1; }
  bool contains(int column, int row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
  void add(int column, int row) { add_run(row, column, column); }
  /// Add the cells `first` … `last` of a row.
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
  void add(const CellBox& box) {
    if (box.empty()) return;
    add_run(box.first_row, box.first_column, box.last_column);
    add_run(box.last_row, box.first_column, box.last_column);
  }
  bool overlaps(const CellBox& box) const {
    return std::max(first_column, box.first_column) <= std::min(last_column, box.last_column) &&
           std::max(first_row, box.first_row) <= std::min(last_row, box.last_row);
  }
  /// Box with margins of that many cells.
  CellBox grown(int columns, int rows) const {
    return {first_column - columns, first_row - rows, last_column + columns, last_row + rows};
  }
  /// Part inside another box; empty if there is none.
  CellBox clipped(const CellBox& box) const {
    const CellBox part{std::max(first_column, box.first_column), std::max(first_row, box.first_row),
                       std::min(last_column, box.last_column), std::min(last_row, box.last_row)};
    return part.empty() || part.rows() <= 0 ? CellBox() : part;
  }
  /// Box with a margin of that many cells, clipped to width×height cells.
  CellBox grown(int margin, int width, int height) const {
    return {std::max(0, first_column - margin), std::max(0, first_row - margin),
            std::min(width - 1, last_column + margin), std::min(height - 1, last_row + margin)};
  }
};

}  // namespace roadstereo
