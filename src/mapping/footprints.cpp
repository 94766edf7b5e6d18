#include "mapping/footprints.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace roadstereo {

void add_cells_inside(const std::array<std::array<double, 2>, 4>& corners, MapCells& cells) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  // The first cell whose centre is not before a coordinate. Adjoining quadrilaterals share no centre.
  const auto first_from = [](double at_m) { return static_cast<std::int32_t>(std::ceil(at_m / footprint_m - 0.5)); };
  double low = unlimited, high = -unlimited;
  for (const auto& corner : corners) {
    low = std::min(low, corner[1]);
    high = std::max(high, corner[1]);
  }
  for (std::int32_t row = first_from(low); row < first_from(high); ++row) {
    const double y = (row + 0.5) * footprint_m;
    double left = unlimited, right = -unlimited;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const auto &a = corners[k], &b = corners[(k + 1) % corners.size()];
      if ((a[1] <= y) == (b[1] <= y)) continue;
      const double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (left > right) continue;
    for (std::int32_t column = first_from(left); column < first_from(right); ++column) cells.push_back({column, row});
  }
}

CellBounds bounds_of(const MapCells& cells) {
  if (cells.empty()) return {};
  CellBounds bounds{cells.front(), cells.back()};  // in the order of rows
  for (const auto& cell : cells) {
    bounds.first[0] = std::min(bounds.first[0], cell[0]);
    bounds.last[0] = std::max(bounds.last[0], cell[0]);
  }
  return bounds;
}

}  // namespace roadstereo
