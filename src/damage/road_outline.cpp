#include "damage/road_outline.hpp"

#include <cmath>

namespace roadstereo {
namespace {

using Corner = std::array<double, 2>;

double distance(const Corner& p, const Corner& a, const Corner& b) {
  const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
  if (length == 0) return std::hypot(p[0] - a[0], p[1] - a[1]);
  return std::abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length;
}

/// Douglas–Peucker between `first` and `last`; appends the corners kept but the last one.
void simplify(const std::vector<Corner>& ring, std::size_t first, std::size_t last, double tolerance,
              std::vector<Corner>& kept) {
  std::size_t farthest = first;
  double most = tolerance;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double off = distance(ring[i], ring[first], ring[last]);
    if (off > most) farthest = i;
    most = std::max(most, off);
  }
  if (farthest == first) {
    kept.push_back(ring[first]);
    return;
  }
  simplify(ring, first, farthest, tolerance, kept);
  simplify(ring, farthest, last, tolerance, kept);
}

}  // namespace

std::vector<Corner> trace_outline(const Image<std::uint16_t>& ids, const Damage& damage, double tolerance_px) {
  const int u0 = damage.box_px[0], v0 = damage.box_px[1], u1 = damage.box_px[2], v1 = damage.box_px[3];
  const auto inside = [&](int u, int v) { return u >= u0 && v >= v0 && u <= u1 && v <= v1 && ids(u, v) == damage.id; };
  int u = u0, v = v0;
  while (v <= v1 && !inside(u, v)) {
    if (++u > u1) {
      u = u0;
      ++v;
    }
  }
  if (v > v1) return {};
  // Corner (u, v) is the upper left one of pixel (u, v). The damage is on the right of the direction of travel.
  constexpr std::array<std::array<int, 2>, 4> steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  constexpr std::array<std::array<int, 2>, 4> ahead_left{{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};
  const int start_u = u, start_v = v;
  std::size_t direction = 0;
  std::vector<Corner> ring;
  do {
    ring.push_back({u - 0.5, v - 0.5});
    do {
      u += steps[direction][0];
      v += steps[direction][1];
      const auto& left = ahead_left[direction];
      const auto& right = ahead_left[(direction + 1) % 4];
      if (inside(u + left[0], v + left[1])) {
        direction = (direction + 3) % 4;
        break;
      }
      if (!inside(u + right[0], v + right[1])) {
        direction = (direction + 1) % 4;
        break;
      }
    } while (true);
  } while (u != start_u || v != start_v || direction != 0);
  std::size_t opposite = 0;
  double most = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double off = distance(ring[i], ring[0], ring[0]);
    if (off > most) opposite = i;
    most = std::max(most, off);
  }
  ring.push_back(ring[0]);
  // Of a thin region a smaller tolerance leaves more than a line.
  constexpr std::size_t min_corners = 3;
  std::vector<Corner> kept;
  for (double tolerance = tolerance_px; kept.size() < min_corners; tolerance /= 2) {
    kept.clear();
    simplify(ring, 0, opposite, tolerance, kept);
    simplify(ring, opposite, ring.size() - 1, tolerance, kept);
  }
  return kept;
}

}  // namespace roadstereo
