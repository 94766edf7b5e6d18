#pragma once

#include <algorithm>
#include <array>
#include <vector>

namespace roadstereo {

/// Andrew's monotone chain. Corners are counterclockwise; the first is not repeated.
inline std::vector<std::array<double, 2>> convex_hull(std::vector<std::array<double, 2>> points) {
  using Point = std::array<double, 2>;
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  const auto turns_left = [](const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
  };
  std::vector<Point> hull;
  hull.reserve(2 * points.size());
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto point = first; point != last; ++point) {
      while (hull.size() >= start + 2 && !turns_left(hull[hull.size() - 2], hull.back(), *point)) hull.pop_back();
      hull.push_back(*point);
    }
    hull.pop_back();
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace roadstereo
