#pragma once

#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Finds the clutter (DamageEvidence::clutter) of each of the damages of an image, candidates included, from the
/// confidences that they have without it, and updates these.
void add_clutter(std::vector<Damage>& damages);

}  // namespace roadstereo
