#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace roadstereo::io {

/// Finds places of the road by the cells of space that they touch, so that a search needs not go through all of them.
class PlaceIndex {
 public:
  /// Adds a ball around a place of `id`, in the world of a piece, metres. An id may have several.
  void add(std::int64_t id, int piece, const std::array<double, 3>& centre_m, double radius_m);

  /// Ids with a ball that this one touches, and some that are near, in ascending order.
  std::vector<std::int64_t> near(int piece, const std::array<double, 3>& centre_m, double radius_m) const;

 private:
  using Cell = std::array<int, 4>;  ///< piece, then the index along each axis

  std::map<Cell, std::vector<std::int64_t>> cells_;  ///< ids that touch each
  std::vector<std::int64_t> large_;                  ///< ids that touch too many cells
};

}  // namespace roadstereo::io
