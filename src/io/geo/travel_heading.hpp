#pragma once

#include <vector>

#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// Gives the points without a heading that of the way travelled around them; where it stands still, the last one since
/// the last gap.
void fill_headings(std::vector<TrackPoint>& points, const TrackOptions& options);

}  // namespace roadstereo::io
