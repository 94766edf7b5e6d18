#include "io/flight/outline_union.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/convex_hull.hpp"

namespace roadstereo::io {

void OutlineUnion::add(const Outline& outline) {
  for (const std::array<int, 2>& cell : cells_of(outline)) {
    if (!cells_.insert(cell).second) continue;
    const double column = cell[0], row = cell[1];
    sum_[0] += column;
    sum_[1] += row;
    squares_[0] += column * column;
    squares_[1] += column * row;
    squares_[2] += row * row;
  }
  hull_.insert(hull_.end(), outline.begin(), outline.end());
  hull_ = convex_hull(std::move(hull_));
}

double OutlineUnion::area_m2() const {
  return static_cast<double>(cells_.size()) * outline_cell_m * outline_cell_m;
}

std::array<double, 2> OutlineUnion::axis() const {
  if (cells_.empty()) return {1, 0};
  const auto count = static_cast<double>(cells_.size());
  const double xx = squares_[0] / count - sum_[0] / count * sum_[0] / count;
  const double xy = squares_[1] / count - sum_[0] / count * sum_[1] / count;
  const double yy = squares_[2] / count - sum_[1] / count * sum_[1] / count;
  const double angle_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

double OutlineUnion::extent_m(const std::array<double, 2>& along) const {
  if (hull_.empty()) return 0;
  const auto at = [&](const std::array<double, 2>& point) { return point[0] * along[0] + point[1] * along[1]; };
  const auto [first, last] = std::minmax_element(
      hull_.begin(), hull_.end(),
      [&](const std::array<double, 2>& a, const std::array<double, 2>& b) { return at(a) < at(b); });
  return at(*last) - at(*first);
}

}  // namespace roadstereo::io
