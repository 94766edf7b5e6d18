#pragma once

#include <cstddef>
#include <vector>

#include "core/box_index.hpp"
#include "mapping/footprints.hpp"

namespace roadstereo {

/// Finds boxes of the map by the blocks of 64 × 64 cells that they touch.
class BoundsIndex {
 public:
  /// Adds a box of finding `number`, which may have several.
  void add(std::size_t number, const CellBounds& bounds) {
    blocks_.add(number, block_of(bounds.first), block_of(bounds.last));
  }

  /// Numbers with a box that overlaps this one, and some that are near, in ascending order.
  std::vector<std::size_t> near(const CellBounds& bounds) const {
    return blocks_.near(block_of(bounds.first), block_of(bounds.last));
  }

 private:
  static std::array<std::int32_t, 2> block_of(const std::array<std::int32_t, 2>& cell) {
    constexpr int block_bits = 6;
    return {cell[0] >> block_bits, cell[1] >> block_bits};
  }

  BoxIndex<std::size_t, 2> blocks_;
};

}  // namespace roadstereo
