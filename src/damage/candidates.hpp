#pragma once

#include <vector>

#include "damage/connected_regions.hpp"
#include "damage/depth_cells.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Depths count positive inside a damage: 1 for depressions, −1 for protrusions.
inline float sign_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1.0F : -1.0F;
}

/// A damage before it is measured.
struct Candidate {
  DamageKind kind = DamageKind::depression;
  Image<std::uint8_t> cells;  ///< 255 inside, of the whole picture
  Box box;
  std::size_t size = 0;  ///< cells
  float level = 0;       ///< depth at its outline, pixels of ℓ'
};

/// What decides which departures from the road are damage, cell by cell.
struct Thresholds {
  bool metric = false;       ///< whether they come from metres
  Image<float> depth;        ///< pixels of ℓ'
  Image<float> deepest;      ///< a depression that is deeper is no damage, pixels of ℓ'
  Image<float> highest;      ///< a protrusion that is higher is none, pixels of ℓ'
  Image<float> least_cells;  ///< area, cells
};

/// The left image in cells, and how far the window of matching reaches; no image when it is empty.
struct Witness {
  Image<float> grey;
  int reach = 0;  ///< cells
};

/// Regions that depart from the road by more than the thresholds and that the road surrounds, deepest first.
std::vector<Candidate> find_candidates(const DepthCells& relief, const Image<std::uint8_t>& road,
                                       const Thresholds& thresholds, const Witness& witness, bool protrusions);

}  // namespace roadstereo
