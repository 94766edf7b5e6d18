#pragma once

#include <vector>

#include "damage/box_mask.hpp"
#include "damage/common_view.hpp"
#include "damage/depth_cells.hpp"
#include "damage/image_outline.hpp"
#include "damage/ruts.hpp"
#include "damage/thresholds.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Sign that makes depths positive inside a damage: 1 for depressions, −1 for protrusions.
inline float sign_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1.0F : -1.0F;
}

/// Below this confidence a region is no candidate.
inline constexpr double min_candidate_confidence = 0.05;

/// Region of a damage before measurement.
struct Candidate {
  DamageKind kind = DamageKind::depression;
  BoxMask cells;         ///< stored in its bounding box
  BoxMask inside;        ///< those inside its rim, `inside_rim`; empty: all
  std::size_t size = 0;  ///< cells
  float level = 0;       ///< depth at the outline, pixels of ℓ'
  double rut_share = 0;  ///< of the cells that lie in one rut
  DamageEvidence evidence;

  const CellBox& box() const { return cells.box(); }
  bool lies_in_rut() const { return rut_share >= 0.5; }
};

/// Find candidates: connected components deeper than the thresholds (cores), extended to their outlines, with the
/// evidence that they are damage. Depressions come first, each kind by decreasing size of the core, potholes in a rut
/// before it. Regions do not overlap, and end at the border of the view. Outliers in them, deeper than a damage can be,
/// become gaps of `depth_cells` at the depth of the floor.
std::vector<Candidate> find_candidates(DepthCells& depth_cells, const Image<std::uint8_t>& road, const CommonView& view,
                                       const Ruts& ruts, const SurfaceCoordinates& coordinates,
                                       const Thresholds& thresholds, const ImageEdges& image_edges, bool protrusions,
                                       int threads);

}  // namespace roadstereo
