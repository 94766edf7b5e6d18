#pragma once

#include <cstddef>
#include <cstdlib>

#include "damage/cell_box.hpp"

namespace roadstereo {

/// Octants around the middle of a box, of the box's proportions.
class Octants {
 public:
  static constexpr std::size_t count = 8;

  explicit Octants(const CellBox& box)
      : middle_i_(box.first_column + box.last_column),
        middle_j_(box.first_row + box.last_row),
        columns_(box.columns()),
        rows_(box.rows()) {}

  /// 0 … 7, around the middle.
  std::size_t of(int i, int j) const {
    const int x = (2 * i - middle_i_) * rows_, y = (2 * j - middle_j_) * columns_;
    const bool is_wide = std::abs(x) > std::abs(y);
    if (y > 0) return x > 0 ? (is_wide ? 0 : 1) : (is_wide ? 3 : 2);
    return x > 0 ? (is_wide ? 7 : 6) : (is_wide ? 4 : 5);
  }

 private:
  int middle_i_, middle_j_, columns_, rows_;
};

}  // namespace roadstereo
