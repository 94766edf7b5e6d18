#pragma once

#include <vector>

#include "damage/connected_components.hpp"
#include "damage/thresholds.hpp"

namespace roadstereo {

/// Where the search for a damage starts.
struct Core {
  ConnectedComponent cells;
  float saddle = 0;  ///< depth down to which it is separate from other cores of its component; 0: it is all of it
  bool is_divided = false;  ///< into other cores: a damage only if none of them is
};

/// Connected components of a mask of deep cells, from the largest to the smallest. A component with several basins,
/// such as two potholes in a gutter, has a core in each: they are separate down to the saddle between them, which is at
/// most half as deep as the floor of either, where a smoothed wall has its middle. Components that are divided come
/// last, for pits in a hollow need not be damage.
class Cores {
 public:
  /// `depth`: positive inside the kind of damage.
  Cores(const Image<float>& depth, const Image<std::uint8_t>& deep, const Thresholds& thresholds);

  std::vector<Core>& cores() { return cores_; }

 private:
  void add(const Image<float>& depth, const Core& core, float min_level, float min_cells);

  ConnectedComponents components_;
  std::vector<std::vector<CellRun>> basins_;  ///< runs of the cores that are not components
  std::vector<Core> cores_;
};

}  // namespace roadstereo
