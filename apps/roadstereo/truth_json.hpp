#pragma once

#include <string>

#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Returns the content of truth.json: plane, roll, rig and all damages of one synthetic pair.
std::string truth_json(const synth::Scene& scene, const synth::SyntheticPair& pair);

}  // namespace roadstereo::cli
