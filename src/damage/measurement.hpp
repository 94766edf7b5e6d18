#pragma once

#include <vector>

#include "damage/candidates.hpp"
#include "damage/depth_cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// What segmentation has found, in cells.
struct Segmentation {
  const Cells& cells;
  const RoadSurface& surface;
  const Image<std::uint8_t>& road;
  const DepthCells& relief;
  std::vector<Candidate> candidates;
};

/// Paints the regions into maps of full size and measures each of them. `result.metric` says whether in metres.
void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& found, int threads,
                    DamageMap& result);

}  // namespace roadstereo
