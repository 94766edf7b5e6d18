#pragma once

#include <span>
#include <vector>

#include "io/geo/geo_columns.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// A part of the track drawn as one line: at least two points. Refers to the track.
struct TrackSegment {
  std::span<const TrackPoint> points;
};

/// Splits the track at gaps and where it crosses ±180°.
std::vector<TrackSegment> track_segments(const Track& track);

const std::vector<GeoColumn<TrackSegment>>& track_segment_columns();

}  // namespace roadstereo::io
