#pragma once

#include <span>
#include <vector>

#include "io/geo/geo_columns.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// A stretch of the track that is drawn as one line: two points or more, of a track that outlives it.
struct TrackStretch {
  std::span<const TrackPoint> points;
};

/// Cut at gaps and where the track crosses ±180°.
std::vector<TrackStretch> track_stretches(const Track& track);

const std::vector<GeoColumn<TrackStretch>>& track_stretch_columns();

}  // namespace roadstereo::io
