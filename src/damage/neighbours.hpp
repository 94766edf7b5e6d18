#pragma once

#include <cstdint>

namespace roadstereo {

/// Position of a cell.
struct CellIndex {
  std::int32_t column = 0, row = 0;
};

/// Call `visit(column, row)` for the 4-neighbours of a cell that lie in an image of columns×rows cells.
template <class Visit>
void for_each_neighbour(int column, int row, int columns, int rows, const Visit& visit) {
  if (column > 0) visit(column - 1, row);
  if (column + 1 < columns) visit(column + 1, row);
  if (row > 0) visit(column, row - 1);
  if (row + 1 < rows) visit(column, row + 1);
}

}  // namespace roadstereo
