#pragma once

#include <cstdint>

namespace roadstereo {

/// A cell of a picture.
struct CellIndex {
  std::int32_t column = 0, row = 0;
};

/// Calls `visit(column, row)` for the cells of a picture that share a side with the given one.
template <class Visit>
void for_neighbours(int column, int row, int columns, int rows, const Visit& visit) {
  if (column > 0) visit(column - 1, row);
  if (column + 1 < columns) visit(column + 1, row);
  if (row > 0) visit(column, row - 1);
  if (row + 1 < rows) visit(column, row + 1);
}

}  // namespace roadstereo
