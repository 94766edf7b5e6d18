#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "mapping/footprints.hpp"

namespace roadstereo {

/// Finds boxes of the map by the blocks of cells that they touch, so that a search needs not go through all of them.
class BoundsIndex {
 public:
  /// Adds a box of finding `number`, which may have several. One without cells is left out.
  void add(std::size_t number, const CellBounds& bounds);

  /// Numbers with a box that overlaps this one, and some that are near, in ascending order.
  std::vector<std::size_t> near(const CellBounds& bounds) const;

 private:
  std::map<std::array<std::int32_t, 2>, std::vector<std::size_t>> blocks_;  ///< numbers that touch each
  std::vector<std::size_t> large_;                                          ///< numbers that touch too many blocks
};

}  // namespace roadstereo
