#pragma once

#include <vector>

#include "damage/candidate_search.hpp"

namespace roadstereo {

/// Depths of the cells of a candidate.
std::vector<float> depths_inside(const SearchImages& images, const Candidate& candidate);

/// Measure what distinguishes a damage from noise and from what is not road.
void add_evidence(const SearchInput& input, SearchImages& images, Candidate& candidate);

/// Upper bound of the confidence, assuming a steep wall and agreement of the images; shows whether it is worth
/// measuring these.
double confidence_at_best(const Candidate& candidate, const Thresholds& thresholds);

}  // namespace roadstereo
