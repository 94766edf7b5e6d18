#include "damage/common_view.hpp"

#include <algorithm>
#include <limits>

namespace roadstereo {

CommonView::CommonView(const DamageInput& input, const Cells& cells)
    : columns_(cells.width()), first_columns_(static_cast<std::size_t>(cells.height()), 0) {
  if (!input.mask.empty()) mark_masked(input.mask, cells);
  if (input.right.empty() || !input.plane) return;
  for (int j = 0; j < cells.height(); ++j) {
    int& first = first_columns_[static_cast<std::size_t>(j)];
    while (first < columns_ && input.plane->disparity(cells.middle(first), cells.middle(j)) > cells.middle(first))
      ++first;
  }
}

void CommonView::mark_masked(ImageView<const std::uint8_t> mask, const Cells& cells) {
  masked_.assign(cells.width(), cells.height(), 0);
  for (int v = 0; v < mask.height(); ++v) {
    const std::uint8_t* const row = mask.row(v);
    std::uint8_t* const of_cells = masked_.row(v / cells.factor);
    for (int u = 0; u < mask.width(); ++u) of_cells[u / cells.factor] |= row[u];
  }
}

void CommonView::remove_outside(Cells& cells) const {
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < columns_; ++i) {
      if (!contains(i, j)) cells.value(i, j) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

void CommonView::fill_outside(Image<std::uint8_t>& mask) const {
  for (int j = 0; j < mask.height(); ++j) {
    for (int i = 0; i < columns_; ++i) {
      if (!contains(i, j)) mask(i, j) = 255;
    }
  }
}

void CommonView::fill_masked(Image<std::uint8_t>& mask) const {
  const std::size_t cells = masked_.empty() ? 0 : mask.pixels();
  for (std::size_t k = 0; k < cells; ++k) {
    if (masked_.row(0)[k] != 0) mask.row(0)[k] = 255;
  }
}

}  // namespace roadstereo
