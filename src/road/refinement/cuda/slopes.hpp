#pragma once

#include "road/refinement/cuda/measured_maps.hpp"
#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/slope.hpp"

namespace roadstereo::cuda {

/// Enqueues the slopes of all pixels (road/refinement/slope.hpp), shrunk by their share.
void find_slopes(const MeasuredMaps& maps, const SlopeSettings& settings, const VarianceBounds& bounds,
                 const SlopeMaps& slopes, StreamView stream);

}  // namespace roadstereo::cuda
