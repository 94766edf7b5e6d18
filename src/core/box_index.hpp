#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace roadstereo {

/// Finds boxes of a grid by the cells that they touch, so that a search needs not go through all of them.
template <class Number, std::size_t Axes>
class BoxIndex {
 public:
  using Cell = std::array<std::int32_t, Axes>;

  /// Adds a box, from its first cell to its last, of `number`, which may have several.
  void add(Number number, const Cell& first, const Cell& last) {
    const auto enter = [number](std::vector<Number>& numbers) {
      if (std::find(numbers.begin(), numbers.end(), number) == numbers.end()) numbers.push_back(number);
    };
    if (!for_each_cell(first, last, [&](const Cell& cell) { enter(cells_[cell]); })) enter(large_);
  }

  /// Numbers with a box that touches a cell of this one, and those with boxes of too many cells, in ascending order.
  std::vector<Number> near(const Cell& first, const Cell& last) const {
    std::vector<Number> numbers = large_;
    const auto collect = [&numbers](const std::vector<Number>& more) {
      numbers.insert(numbers.end(), more.begin(), more.end());
    };
    const auto look_up = [&](const Cell& cell) {
      if (const auto found = cells_.find(cell); found != cells_.end()) collect(found->second);
    };
    if (!for_each_cell(first, last, look_up)) {
      for (const auto& [cell, entered] : cells_) collect(entered);
    }
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
  }

 private:
  /// Calls `visit` for each cell of a box. Returns false, without a call, if there are too many.
  template <class Visit>
  static bool for_each_cell(const Cell& first, const Cell& last, const Visit& visit) {
    constexpr double most = 1000;
    double count = 1;
    for (std::size_t axis = 0; axis < Axes; ++axis) count *= std::max(0.0, 1.0 + last[axis] - first[axis]);
    if (count > most) return false;
    Cell cell = first;
    for (; count > 0; --count) {
      visit(cell);
      for (std::size_t axis = Axes; axis-- > 0 && ++cell[axis] > last[axis];) cell[axis] = first[axis];
    }
    return true;
  }

  std::map<Cell, std::vector<Number>> cells_;  ///< numbers that touch each
  std::vector<Number> large_;                  ///< numbers that touch too many cells
};

}  // namespace roadstereo
