#include "damage/box_mask.hpp"

#include <algorithm>

namespace roadstereo {

BoxMask BoxMask::cropped(const CellBox& box) const {
  BoxMask part(box);
  const int first_column = std::max(box.first_column, box_.first_column);
  const int last_column = std::min(box.last_column, box_.last_column);
  if (last_column < first_column) return part;
  for (int j = std::max(box.first_row, box_.first_row); j <= std::min(box.last_row, box_.last_row); ++j) {
    std::copy_n(cells_.row(j - box_.first_row) + (first_column - box_.first_column), last_column - first_column + 1,
                part.cells_.row(j - box.first_row) + (first_column - box.first_column));
  }
  return part;
}

std::size_t cell_count(const BoxMask& mask) {
  const std::uint8_t* const cells = mask.cells().row(0);
  return static_cast<std::size_t>(std::count_if(cells, cells + mask.cells().pixels(), [](auto c) { return c != 0; }));
}

}  // namespace roadstereo
