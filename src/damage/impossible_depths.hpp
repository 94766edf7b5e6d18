#pragma once

#include "damage/candidate_search.hpp"
#include "damage/connected_components.hpp"

namespace roadstereo {

/// Whether the floor of a core is deeper, or higher, than a damage can be. Its cells that are become obstacles.
bool is_obstacle(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, const Image<float>& depth,
                 Image<std::uint8_t>& assigned);

/// Whether `remove_outliers` would change a core.
bool has_outliers(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, const Image<float>& depth);

/// Turn outliers into gaps: the cells around those that are deeper, or higher, than a damage can be, as wrong matches
/// at snow or dirt make them. They take the depth of the floor.
void remove_outliers(const SearchInput& input, const ConnectedComponent& core, DamageKind kind, SearchImages& images);

}  // namespace roadstereo
