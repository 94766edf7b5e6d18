#pragma once

#include "damage/candidate_search.hpp"
#include "damage/connected_components.hpp"

namespace roadstereo {

/// Where the outline of a hole has leaked over a step of the road, as at the edge of an overlay, raises the level until
/// the lower side of the step is left out, if the hole is likely damage without it. A stone or a twig is cut out of the
/// gentle relief of the road in any case.
void leave_terrace(const SearchInput& input, float min_cells, SearchImages& images, Candidate& candidate);

/// The hollow around a core at a higher level, if it is more likely damage at that level. Where the relief of the road
/// is as steep as the wall, the outline leaks out of the hole into a shallow hollow, and the contrast is lost.
void raise_level(const SearchInput& input, const ConnectedComponent& core, float min_cells, SearchImages& images,
                 Candidate& candidate);

}  // namespace roadstereo
