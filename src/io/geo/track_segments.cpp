#include "io/geo/track_segments.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <cmath>

namespace roadstereo::io {
namespace {

bool is_cut(const TrackPoint& before, const TrackPoint& after, const TrackOptions& options) {
  return after.time_s - before.time_s > options.max_gap_s || std::abs(after.lon_deg - before.lon_deg) > 180;
}

double length_m(const TrackSegment& segment) {
  double sum_m = 0;
  for (std::size_t i = 1; i < segment.points.size(); ++i) {
    const TrackPoint& from = segment.points[i - 1];
    const TrackPoint& to = segment.points[i];
    double way_m = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m);
    sum_m += way_m;
  }
  return sum_m;
}

}  // namespace

std::vector<TrackSegment> track_segments(const Track& track) {
  const std::span<const TrackPoint> points = track.points();
  std::vector<TrackSegment> segments;
  std::size_t from = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    if (i < points.size() && !is_cut(points[i - 1], points[i], track.options())) continue;
    if (i - from > 1) segments.push_back({points.subspan(from, i - from)});
    from = i;
  }
  return segments;
}

const std::vector<GeoColumn<TrackSegment>>& track_segment_columns() {
  static const std::vector<GeoColumn<TrackSegment>> columns = {
      {"start_utc", GeoType::time, [](const TrackSegment& s) { return geo_time(s.points.front().time_s); }},
      {"end_utc", GeoType::time, [](const TrackSegment& s) { return geo_time(s.points.back().time_s); }},
      {"points", GeoType::whole, [](const TrackSegment& s) { return static_cast<std::int64_t>(s.points.size()); }},
      {"length_m", GeoType::number, [](const TrackSegment& s) { return length_m(s); }}};
  return columns;
}

}  // namespace roadstereo::io
