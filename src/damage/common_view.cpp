#include "damage/common_view.hpp"

#include <algorithm>
#include <limits>

namespace roadstereo {

CommonView::CommonView(const DamageInput& input, const Cells& cells)
    : columns_(cells.width()), first_columns_(static_cast<std::size_t>(cells.height()), 0) {
  if (input.right.empty() || !input.plane) return;
  for (int j = 0; j < cells.height(); ++j) {
    int& first = first_columns_[static_cast<std::size_t>(j)];
    while (first < columns_ && input.plane->disparity(cells.middle(first), cells.middle(j)) > cells.middle(first))
      ++first;
  }
}

void CommonView::remove_outside(Cells& cells) const {
  for (int j = 0; j < cells.height(); ++j) {
    std::fill_n(cells.value.row(j), first_column(j), std::numeric_limits<float>::quiet_NaN());
  }
}

}  // namespace roadstereo
