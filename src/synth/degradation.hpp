#pragma once

#include <cstdint>

#include "roadstereo/synth.hpp"

namespace roadstereo::synth {

/// Turns the light that falls on a sensor into the picture the camera delivers: blur, motion blur, gain and
/// exposure, noise, clipping and 8 bits, in this order. `light` is in grey levels and is used up.
/// `gain` multiplies this camera's picture; `noise_key` tells this camera's noise from the other's.
Frame take_picture(Image<float>& light, const Degradation& degradation, double gain, std::uint64_t noise_key,
                   int threads);

}  // namespace roadstereo::synth
