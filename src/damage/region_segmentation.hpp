#pragma once

#include "damage/candidate_search.hpp"
#include "damage/connected_components.hpp"
#include "damage/cores.hpp"

namespace roadstereo {

/// Rows of cells over which the support window carries the road into a region of that box: as few as the road is
/// foreshortened there.
int window_rows(const SearchInput& input, const CellBox& box);

/// Segment the region around a core. If it runs into another damage or an obstacle, the level is raised above the
/// saddle between them; it is never below that of the core. Size 0 if there is no such region.
Candidate segment(const SearchInput& input, const Core& start, DamageKind kind, SearchImages& images);

/// The region of a hollow at another level, with its evidence; size 0 if it is none.
Candidate region_at(const SearchInput& input, const ConnectedComponent& core, float level, float min_cells,
                    const Candidate& lower, SearchImages& images);

/// Remove assigned cells, those outside the view and what is not seen, and recompute the bounding box and the size.
void update_extent(const SearchInput& input, const Image<std::uint8_t>& assigned, Candidate& candidate);

/// Whether a cell of the candidate is measured, not interpolated.
bool is_measured(const Candidate& candidate, const Image<std::uint8_t>& valid);

}  // namespace roadstereo
