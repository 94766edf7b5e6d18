#include "core/straightedge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadstereo {
namespace {

struct Point {
  double x, z;
  std::size_t index;
};

/// Cross product of ab and ac: positive if c lies above the line through a and b.
double side(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

/// Vertical distances of points, sorted by x, from their upper hull (monotone chain), where larger than `gaps`.
void add_gaps_below_hull(std::span<const Point> points, std::vector<Point>& hull, std::vector<double>& gaps) {
  hull.clear();
  for (const Point& point : points) {
    while (hull.size() >= 2 && side(hull[hull.size() - 2], hull.back(), point) >= 0) hull.pop_back();
    hull.push_back(point);
  }
  std::size_t edge = 0;
  for (const Point& point : points) {
    while (edge + 2 < hull.size() && hull[edge + 1].x < point.x) ++edge;
    if (edge + 1 >= hull.size()) break;
    const Point &a = hull[edge], &b = hull[edge + 1];
    double& gap = gaps[point.index];
    gap = std::max(gap, a.z + (b.z - a.z) * (point.x - a.x) / (b.x - a.x) - point.z);
  }
}

}  // namespace

std::vector<double> straightedge_gaps(std::span<const double> heights_m, double spacing_m, double straightedge_m) {
  std::vector<double> gaps(heights_m.size(), 0.0);
  std::vector<Point> points;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    if (std::isfinite(heights_m[i])) points.push_back({static_cast<double>(i) * spacing_m, heights_m[i], i});
  }
  if (points.size() < 3) return gaps;
  constexpr double rounding = 1e-9;
  std::vector<Point> hull;
  std::size_t last = 0;
  for (std::size_t first = 0; first < points.size(); ++first) {
    const std::size_t before = last;
    while (last < points.size() && points[last].x - points[first].x <= straightedge_m + rounding) ++last;
    if (first > 0 && last == before) continue;  // inside the previous window
    add_gaps_below_hull(std::span(points).subspan(first, last - first), hull, gaps);
  }
  return gaps;
}

}  // namespace roadstereo
