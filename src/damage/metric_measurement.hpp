#pragma once

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

/// Slope of the steepest wall that the support window of matching, which spreads a vertical one over its radius between
/// a quarter and three quarters of the height, makes as gentle as measured; infinite for a vertical one. `pixels`: of
/// the damage.
double possible_wall_slope(const DamageMetrics& metrics, std::size_t pixels);

/// Compute the metric properties of a damage, but for its distress and severity, and the likely slope of its wall,
/// evidence of it. The depths of `maps` are in pixels of ℓ'.
DamageMetrics compute_metrics(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                              const SurfaceOffset& offset, const DamageMap& maps, Damage& damage);

/// Reduce area and outline of a damage to the pixels that `maps` has left inside its rim. The volume remains that of
/// all: averaging moves it beyond the rim, but keeps it.
void keep_inside_rim(const DamageInput& input, const FrameGeometry& geometry, const SurfaceOffset& offset,
                     const DamageMap& maps, const Damage& damage, DamageMetrics& metrics);

}  // namespace roadstereo
