#include "road/off_road/cell_map.hpp"

#include <algorithm>

#include "roadstereo/error.hpp"

namespace roadstereo {

void connect_with_border(CellMap<CellState>& states) {
  auto front = scratch_vector<int>();
  front.reserve(states.values.size());
  const auto visit = [&](int i, int j) {
    CellState& state = states.row(j)[i];
    if (state != unconfirmed) return;
    state = off_road;
    front.push_back(j * states.columns + i);
  };
  for (int i = 0; i < states.columns; ++i) visit(i, 0);
  for (int j = 0; j < states.rows; ++j) {
    visit(0, j);
    visit(states.columns - 1, j);
  }
  while (!front.empty()) {
    const int i = front.back() % states.columns, j = front.back() / states.columns;
    front.pop_back();
    for (int y = std::max(0, j - 1); y <= std::min(states.rows - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(states.columns - 1, i + 1); ++x) visit(x, y);
    }
  }
}

void require_equal_sizes(ImageView<const float> disparity, ImageView<const float> sigma) {
  if (sigma.width() == disparity.width() && sigma.height() == disparity.height()) return;
  fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels and its standard errors ",
       sigma.width(), "×", sigma.height(), "; they must be equal");
}

}  // namespace roadstereo
