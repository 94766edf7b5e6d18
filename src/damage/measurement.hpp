#pragma once

#include <vector>

#include "damage/candidates.hpp"
#include "damage/depth_cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// Result of the segmentation, in cells.
struct Segmentation {
  const Cells& cells;
  const RoadSurface& surface;
  const Image<std::uint8_t>& road;
  const DepthCells& depth_cells;
  std::vector<Candidate> candidates;
};

/// Fill the maps of `result` at full resolution and measure every candidate, in metres if `result.metric` is set.
/// Candidates that are not deep enough are removed; the others are numbered by decreasing depth.
void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    int threads, DamageMap& result);

}  // namespace roadstereo
