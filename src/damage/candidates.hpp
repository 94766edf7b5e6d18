#pragma once

#include <vector>

#include "damage/box_mask.hpp"
#include "damage/depth_cells.hpp"
#include "damage/image_outline.hpp"
#include "damage/thresholds.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Depths count positive inside a damage: 1 for depressions, −1 for protrusions.
inline float sign_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1.0F : -1.0F;
}

/// A damage before it is measured.
struct Candidate {
  DamageKind kind = DamageKind::depression;
  BoxMask cells;         ///< its box is the smallest
  std::size_t size = 0;  ///< cells
  float level = 0;       ///< depth at its outline, pixels of ℓ'

  const Box& box() const { return cells.box(); }
};

/// Regions that depart from the road by more than the thresholds and that the road surrounds, deepest first.
std::vector<Candidate> find_candidates(const DepthCells& relief, const Image<std::uint8_t>& road,
                                       const Thresholds& thresholds, const Witness& witness, bool protrusions);

}  // namespace roadstereo
