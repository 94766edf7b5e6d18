#pragma once

#include <vector>

#include "damage/frame_geometry.hpp"
#include "damage/measurement.hpp"

namespace roadstereo {

/// Offset of the intact road around a damage from the fitted surface, added to the surface for the measurement.
struct SurfaceOffset {
  double value = 0;      ///< pixels of ℓ'
  double std_error = 0;  ///< of the undamaged surface across the damage, pixels of ℓ'
};

/// Estimate the offset as the median over a ring of intact road around the candidate.
SurfaceOffset estimate_surface_offset(const Segmentation& segmentation, const Candidate& candidate);

/// Fill the metric properties of every damage. `offsets` has one element per damage; `result.depth` is in pixels of ℓ'.
void measure_in_metres(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                       const std::vector<SurfaceOffset>& offsets, DamageMap& result);

/// Convert `result.depth` in place from pixels of ℓ' to metres along the road's normal.
void depth_to_metres(const FrameGeometry& geometry, int threads, DamageMap& result);

}  // namespace roadstereo
