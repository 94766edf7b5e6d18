#pragma once

#include <span>
#include <string>
#include <vector>

#include "roadstereo/map_inventory.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo::cli {

/// Whether the strip of a profile, `options.average_m` of the lane, crosses a damage other than a rut: its depth is not
/// that of a rut.
bool crosses_damage(const TransverseProfile& profile, std::span<const RoadDamageRecord> damages,
                    const LaneOptions& options = {});

/// Describes the ruts of the profiles that cross no damage in one line: median, or the largest of few.
std::string rut_text(std::span<const LaneProfiles> lanes, std::span<const RoadDamageRecord> damages);

}  // namespace roadstereo::cli
