#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/box_index.hpp"

namespace roadstereo::io {

/// Finds places of the road by the cells of space, of 4 m, that they touch.
class PlaceIndex {
 public:
  /// Adds a ball around a place of `id`, in the world of a piece, metres. An id may have several.
  void add(std::int64_t id, int piece, const std::array<double, 3>& centre_m, double radius_m) {
    cells_.add(id, cell_of(piece, centre_m, -radius_m), cell_of(piece, centre_m, radius_m));
  }

  /// Ids with a ball that this one touches, and some that are near, in ascending order.
  std::vector<std::int64_t> near(int piece, const std::array<double, 3>& centre_m, double radius_m) const {
    return cells_.near(cell_of(piece, centre_m, -radius_m), cell_of(piece, centre_m, radius_m));
  }

 private:
  /// Piece, then the index along each axis, of a corner of the box around a ball. Beyond all others where the box is
  /// not finite: it then has too many cells.
  static std::array<std::int32_t, 4> cell_of(int piece, const std::array<double, 3>& centre_m, double to_corner_m) {
    constexpr double cell_m = 4, farthest = 1e9;
    std::array<std::int32_t, 4> cell{piece};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double index = std::floor((centre_m[axis] + to_corner_m) / cell_m);
      using Limits = std::numeric_limits<std::int32_t>;
      const std::int32_t beyond = std::signbit(to_corner_m) ? Limits::min() : Limits::max();
      cell[axis + 1] = std::abs(index) < farthest ? static_cast<std::int32_t>(index) : beyond;
    }
    return cell;
  }

  BoxIndex<std::int64_t, 4> cells_;
};

}  // namespace roadstereo::io
