#include "damage/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/convex_hull.hpp"

namespace roadstereo {
namespace {

using Point = std::array<double, 2>;

/// Sides of the bounding rectangle along and across the direction (c, s).
std::array<double, 2> sides_along(const std::vector<Point>& hull, double c, double s) {
  double min_along = std::numeric_limits<double>::infinity();
  double max_along = -min_along;
  double min_across = min_along;
  double max_across = -min_along;
  for (const Point& point : hull) {
    const double along = c * point[0] + s * point[1];
    const double across = c * point[1] - s * point[0];
    min_along = std::min(min_along, along);
    max_along = std::max(max_along, along);
    min_across = std::min(min_across, across);
    max_across = std::max(max_across, across);
  }
  return {max_along - min_along, max_across - min_across};
}

/// Add or subtract π once towards −π/2 … π/2.
double wrap_half_turn(double angle) {
  if (angle > std::numbers::pi / 2) return angle - std::numbers::pi;
  if (angle <= -std::numbers::pi / 2) return angle + std::numbers::pi;
  return angle;
}

}  // namespace

OrientedBox oriented_box(std::vector<Point> points) {
  const std::vector<Point> hull = convex_hull(std::move(points));
  OrientedBox best;
  double min_area = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; hull.size() > 1 && k < hull.size(); ++k) {
    const Point& from = hull[k];
    const Point& to = hull[(k + 1) % hull.size()];
    const double angle = std::atan2(to[1] - from[1], to[0] - from[0]);
    const auto [along, across] = sides_along(hull, std::cos(angle), std::sin(angle));
    if (along * across >= min_area) continue;
    min_area = along * across;
    best = {std::max(along, across), std::min(along, across),
            wrap_half_turn(wrap_half_turn(along >= across ? angle : angle + std::numbers::pi / 2))};
  }
  return best;
}

}  // namespace roadstereo
