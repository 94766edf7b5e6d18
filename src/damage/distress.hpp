#pragma once

#include "roadstereo/damage.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Decide the distress of a damage from its metrics: side, slope of the wall, elongation, direction, height.
/// `possible_slope` is the slope that the wall may have; `at_side`: it reaches the side of the view.
Distress classify_distress(const Damage& damage, const DamageMetrics& metrics, double mount_yaw_deg,
                           double possible_slope, bool at_side);

/// What else is known of the depth that decides a severity.
struct GradedDepth {
  bool resolvable = true;  ///< it is at least three of its standard errors
  bool at_least = false;   ///< it is a lower bound: `Damage::ends_search`
};

/// Set quantity, unit, probabilities and severity by the table of the distress. A damage whose depth is a lower bound
/// has the severity that any greater depth has, too.
void grade(const SeverityScheme& scheme, const GradedDepth& depth, DamageMetrics& metrics);

}  // namespace roadstereo
#pragma GCC visibility pop
