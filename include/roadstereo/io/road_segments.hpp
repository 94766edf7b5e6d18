#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "roadstereo/io/geo_files.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// A stretch of the road between two stations. NaN: unknown.
struct RoadSegment {
  double from_m = 0, to_m = 0;  ///< stations: distance along the positions of the frames
  std::int64_t frames = 0;
  std::int64_t inspected = 0;  ///< frames in which damage was searched for; if there is none, nothing is known of it
  std::int64_t damages = 0;    ///< without candidates
  double area_m2 = 0;          ///< sum over its damages; that of one that goes on is spread evenly
  std::int64_t worst = 0;      ///< id of its worst damage; 0: none
  double roll_rad = 0;         ///< median over its frames
  double height_m = 0;         ///< of the camera above the road, median over its frames
};

/// Divides the road into segments of `length_m`, metres, from 0 to the largest station of a frame. Empty if no frame
/// has a position. Frames at other stations, and at unknown ones, are left out, as are the damages that were measured
/// there; damages before or beyond the frames are of the first or the last segment. Throws Error naming
/// `length_m` unless it is above 0 and makes at most ten million segments.
std::vector<RoadSegment> road_segments(std::span<const GeoFrame> frames, std::span<const RoadDamage> damages,
                                       double length_m = 20);

/// Returns segments.csv: from_m, to_m, frames, inspected, damages, area_m2, worst, worst_distress, worst_severity,
/// roll_deg, height_m.
std::string segments_csv(std::span<const RoadSegment> segments, std::span<const RoadDamage> damages);

}  // namespace roadstereo::io
#pragma GCC visibility pop
