#pragma once

#include <span>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Gaps below a straightedge: the largest distance of each height of a profile from the upper hull of any window of the
/// length of the straightedge. Heights are `spacing_m` apart; NaN is a gap of the profile, of which the distance is 0.
std::vector<double> straightedge_gaps(std::span<const double> heights_m, double spacing_m, double straightedge_m);

}  // namespace roadstereo
#pragma GCC visibility pop
