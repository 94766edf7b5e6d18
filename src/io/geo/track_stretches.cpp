#include "io/geo/track_stretches.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <cmath>

namespace roadstereo::io {
namespace {

bool is_cut(const TrackPoint& before, const TrackPoint& after, const TrackOptions& options) {
  return after.time_s - before.time_s > options.max_gap_s || std::abs(after.lon_deg - before.lon_deg) > 180;
}

double length_m(const TrackStretch& stretch) {
  double sum_m = 0;
  for (std::size_t i = 1; i < stretch.points.size(); ++i) {
    const TrackPoint& from = stretch.points[i - 1];
    const TrackPoint& to = stretch.points[i];
    double way_m = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m);
    sum_m += way_m;
  }
  return sum_m;
}

}  // namespace

std::vector<TrackStretch> track_stretches(const Track& track) {
  const std::span<const TrackPoint> points = track.points();
  std::vector<TrackStretch> stretches;
  std::size_t from = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    if (i < points.size() && !is_cut(points[i - 1], points[i], track.options())) continue;
    if (i - from > 1) stretches.push_back({points.subspan(from, i - from)});
    from = i;
  }
  return stretches;
}

const std::vector<GeoColumn<TrackStretch>>& track_stretch_columns() {
  static const std::vector<GeoColumn<TrackStretch>> columns = {
      {"start_utc", GeoType::time, [](const TrackStretch& s) { return geo_time(s.points.front().time_s); }},
      {"end_utc", GeoType::time, [](const TrackStretch& s) { return geo_time(s.points.back().time_s); }},
      {"points", GeoType::whole, [](const TrackStretch& s) { return static_cast<std::int64_t>(s.points.size()); }},
      {"length_m", GeoType::number, [](const TrackStretch& s) { return length_m(s); }}};
  return columns;
}

}  // namespace roadstereo::io
