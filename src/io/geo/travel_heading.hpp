#pragma once

#include <vector>

#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// Computes unknown headings from the movement around each point; at standstill keeps the last heading since the last
/// gap.
void fill_headings(std::vector<TrackPoint>& points, const TrackOptions& options);

}  // namespace roadstereo::io
