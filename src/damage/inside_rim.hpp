#pragma once

#include "damage/candidate_search.hpp"

namespace roadstereo {

/// The cells of a candidate inside its rim, one connected part. Matching and cells average, which spreads a steep wall,
/// half of it beyond the rim. The true wall is steeper than the measured one by what a Gaussian adds to the square of
/// its run, and its upper end is the rim: shallower cells do not count, unless the picture shows them inside. Empty if
/// all count, as in ruts and without a calibration, where the outline is at half of the depth.
BoxMask inside_rim(const SearchInput& input, const SearchImages& images, const Candidate& candidate);

}  // namespace roadstereo
