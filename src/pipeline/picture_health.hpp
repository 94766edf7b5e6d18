#pragma once

#include "roadstereo/health.hpp"

namespace roadstereo {

/// Measure exposure, blur, noise and compression from the grey levels of the road in both views.
void measure_pictures(const FrameResult& frame, const DamageMap& damage, int threads, PairHealth& health);

}  // namespace roadstereo
