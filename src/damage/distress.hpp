#pragma once

#include "roadstereo/damage.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Decide the distress of a damage from its metrics: side, slope of the wall, elongation, direction, height.
/// `possible_slope` is the slope that the wall may have; `at_side`: it reaches the side of the view.
Distress classify_distress(const Damage& damage, const DamageMetrics& metrics, double mount_yaw_deg,
                           double possible_slope, bool at_side);

/// Set quantity, unit, probabilities and severity by the table of the distress. `resolvable`: whether a depth is at
/// least three of its standard errors.
void grade(const SeverityScheme& scheme, bool resolvable, DamageMetrics& metrics);

}  // namespace roadstereo
#pragma GCC visibility pop
