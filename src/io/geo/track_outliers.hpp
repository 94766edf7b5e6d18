#pragma once

#include <vector>

#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// Whether a vehicle or a drone can come from one fix to the later one: at 100 m/s, and 10 m more for their errors.
bool is_reachable(const TrackPoint& from, const TrackPoint& to);

/// Removes and returns the fixes that cannot be reached from the one before while one after them, within the largest
/// gap, can; of the first and the last fix those that have no such neighbour; and stretches, however long, that cannot
/// be reached from the longest one, or it from them. Of two that are as long as each other none is removed.
std::vector<TrackPoint> take_outliers(std::vector<TrackPoint>& points, const TrackOptions& options);

}  // namespace roadstereo::io
