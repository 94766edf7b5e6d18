#pragma once

#include <optional>
#include <vector>

#include "damage/candidates.hpp"
#include "damage/depth_cells.hpp"
#include "damage/frame_geometry.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// Result of the segmentation, in cells.
struct Segmentation {
  const Cells& cells;
  const CommonView& view;
  const SurfaceCoordinates& coordinates;
  const RoadSurface& surface;
  const Image<std::uint8_t>& road;
  const DepthCells& depth_cells;
  std::vector<Candidate> candidates;
};

/// Measure every candidate, in metres if `result` is metric, slopes of walls if there is a `geometry`, and complete the
/// maps of `result`, which `fill_road_rows` has filled. Candidates that are not deep enough are removed; the others are
/// numbered by decreasing depth.
void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    const std::optional<FrameGeometry>& geometry, int threads, DamageMap& result);

}  // namespace roadstereo
