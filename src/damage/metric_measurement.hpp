#pragma once

#include <vector>

#include "damage/frame_geometry.hpp"
#include "damage/measurement.hpp"

namespace roadstereo {

/// How much the road right around a damage differs from the fitted surface: the surface is raised by `value` there.
struct SurfaceOffset {
  double value = 0;      ///< pixels of ℓ'
  double std_error = 0;  ///< of the undamaged surface across the hole, pixels
};
SurfaceOffset local_surface_offset(const Segmentation& found, const Candidate& candidate);

/// Fills the metric figures of every damage, each with the offset of the surface around it; `result.depth` is in
/// pixels.
void measure_in_metres(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                       const std::vector<SurfaceOffset>& offsets, DamageMap& result);

/// Turns `result.depth` from pixels of ℓ' to metres along the road's normal.
void depth_to_metres(const FrameGeometry& geometry, int threads, DamageMap& result);

}  // namespace roadstereo
