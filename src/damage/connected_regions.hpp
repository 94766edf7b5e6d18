#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "damage/box.hpp"

namespace roadstereo {

/// Cells of one row that hang together, from the first to the last.
struct CellRun {
  int row = 0, first = 0, last = 0;
};

/// Cells of a mask that hang together, by their sides.
struct ConnectedRegion {
  std::span<const CellRun> runs;  ///< row by row, from the left to the right
  std::size_t size = 0;           ///< cells
  Box box;
  bool touches_border = false;
};

/// The regions of the cells that are not 0, or of those that are, in the order of their first cells.
class ConnectedRegions {
 public:
  enum class Of { set, unset };
  explicit ConnectedRegions(const Image<std::uint8_t>& mask, Of which = Of::set);
  ConnectedRegions(ConnectedRegions&&) = default;
  ConnectedRegions& operator=(ConnectedRegions&&) = default;

  std::size_t size() const { return regions_.size(); }
  auto begin() const { return regions_.begin(); }
  auto end() const { return regions_.end(); }

 private:
  std::vector<CellRun> runs_;  ///< region by region
  std::vector<ConnectedRegion> regions_;
};

/// Gives the cells of a region a value.
void paint(const ConnectedRegion& region, std::uint8_t value, Image<std::uint8_t>& mask);

/// Sets every part of `mask` that is 0 and enclosed by it, when it has at most `most_cells`.
void fill_enclosed(Image<std::uint8_t>& mask, std::size_t most_cells);

}  // namespace roadstereo
