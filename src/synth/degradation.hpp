#pragma once

#include <cstdint>

#include "roadstereo/synth.hpp"

namespace roadstereo::synth {

/// Simulate a camera: blur, motion blur, gain and exposure, noise, clipping and quantisation to 8 bits, in this order.
/// `irradiance` is in 8-bit grey levels and is overwritten. `gain` scales the image of this camera; `noise_key` seeds
/// its noise.
Frame simulate_camera(Image<float>& irradiance, const Degradation& degradation, double gain, std::uint64_t noise_key,
                      int threads);

}  // namespace roadstereo::synth
