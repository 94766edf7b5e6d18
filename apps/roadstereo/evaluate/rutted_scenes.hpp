#pragma once

#include <cstdint>

#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Random road with a rut or two wheel tracks that run through the picture, below a rig of a car or a drone, degraded
/// as synth::random_scene is. The same seed gives the same scene.
synth::Scene rutted_scene(std::uint64_t seed);

}  // namespace roadstereo::cli
