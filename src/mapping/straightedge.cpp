#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "roadstereo/road_profile.hpp"

namespace roadstereo {
namespace {

struct Point {
  double x, z;
};

/// Cross product of ab and ac: positive if c lies above the line through a and b.
double side(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
}

/// Largest vertical distance of points, sorted by x, from their upper hull (monotone chain).
double gap_below_hull(std::span<const Point> points, std::vector<Point>& hull) {
  hull.clear();
  for (const Point& point : points) {
    while (hull.size() >= 2 && side(hull[hull.size() - 2], hull.back(), point) >= 0) hull.pop_back();
    hull.push_back(point);
  }
  double gap = 0;
  std::size_t edge = 0;
  for (const Point& point : points) {
    while (edge + 2 < hull.size() && hull[edge + 1].x < point.x) ++edge;
    if (edge + 1 >= hull.size()) break;
    const Point &a = hull[edge], &b = hull[edge + 1];
    gap = std::max(gap, a.z + (b.z - a.z) * (point.x - a.x) / (b.x - a.x) - point.z);
  }
  return gap;
}

}  // namespace

double straightedge_gap(std::span<const double> heights_m, double spacing_m, double straightedge_m) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    if (std::isfinite(heights_m[i])) points.push_back({static_cast<double>(i) * spacing_m, heights_m[i]});
  }
  if (points.size() < 3) return 0;
  constexpr double rounding = 1e-9;
  std::vector<Point> hull;
  double gap = 0;
  std::size_t last = 0;
  for (std::size_t first = 0; first < points.size(); ++first) {
    const std::size_t before = last;
    while (last < points.size() && points[last].x - points[first].x <= straightedge_m + rounding) ++last;
    if (first > 0 && last == before) continue;  // inside the previous window
    gap = std::max(gap, gap_below_hull(std::span(points).subspan(first, last - first), hull));
  }
  return gap;
}

double straightedge_noise_gap(std::size_t heights, double spacing_m, double straightedge_m) {
  constexpr int trials = 64, uniforms = 12;
  std::minstd_rand random(1);
  const auto normal = [&] {  // sum of twelve uniform numbers: the same with every standard library
    double sum = -0.5 * uniforms;
    for (int i = 0; i < uniforms; ++i)
      sum += static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max());
    return sum;
  };
  std::vector<double> profile(heights);
  double mean = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::generate(profile.begin(), profile.end(), normal);
    mean += straightedge_gap(profile, spacing_m, straightedge_m) / trials;
  }
  return mean;
}

}  // namespace roadstereo
