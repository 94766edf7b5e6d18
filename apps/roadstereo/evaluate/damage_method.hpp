// Methods whose damage is scored: a preset, and disparity maps of others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/given_maps.hpp"
#include "pair_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Disparities of a preset, or given maps.
struct DamageMethod {
  std::string name;               ///< of the preset, or of the maps
  std::optional<GivenMaps> maps;  ///< absent: the preset matches
};

/// The preset, then every set of maps.
std::vector<DamageMethod> damage_methods(const std::string& preset, const std::vector<GivenMaps>& maps);

/// A frame and its damage.
struct FrameDamage {
  FrameResult frame;
  DamageMap map;
};

/// Match the pair, or read its map, and find the damage. Roll, road and damage of a given map are computed as
/// `inspect --disparity` does. Throws Error when there is no map for the frame.
FrameDamage find_damage_of(const DamageMethod& method, const StereoPair& pair, const std::string& frame);

}  // namespace roadstereo::cli
