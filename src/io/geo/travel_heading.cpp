#include "io/geo/travel_heading.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace roadstereo::io {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool is_gap(const TrackPoint& before, const TrackPoint& after, const TrackOptions& options) {
  return after.time_s - before.time_s > options.max_gap_s;
}

/// First and last point of the window around a point.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
};

Window window_around(const std::vector<TrackPoint>& points, std::size_t middle, const TrackOptions& options) {
  Window window{middle, middle};
  const double time_s = points[middle].time_s;
  while (window.first > 0 && time_s - points[window.first - 1].time_s <= options.heading_window_s &&
         !is_gap(points[window.first - 1], points[window.first], options)) {
    --window.first;
  }
  while (window.last + 1 < points.size() && points[window.last + 1].time_s - time_s <= options.heading_window_s &&
         !is_gap(points[window.last], points[window.last + 1], options)) {
    ++window.last;
  }
  return window;
}

/// Azimuth over the smallest symmetric span around the point that is long enough; NaN if there is none.
double travel_heading(const std::vector<TrackPoint>& points, std::size_t middle, const TrackOptions& options) {
  const Window window = window_around(points, middle, options);
  const std::size_t widest = std::max(middle - window.first, window.last - middle);
  for (std::size_t span = 1, before = 0; before < widest; before = span, span *= 2) {
    const TrackPoint& from = points[middle - std::min(span, middle - window.first)];
    const TrackPoint& to = points[middle + std::min(span, window.last - middle)];
    double way_m = 0;
    double from_deg = 0;
    double to_deg = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m, from_deg,
                                             to_deg);
    if (way_m >= options.min_heading_distance_m) return from_deg + std::remainder(to_deg - from_deg, 360.0) / 2;
  }
  return unknown;
}

}  // namespace

void fill_headings(std::vector<TrackPoint>& points, const TrackOptions& options) {
  std::vector<double> headings;
  headings.reserve(points.size());
  double last = unknown;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && is_gap(points[i - 1], points[i], options)) last = unknown;
    double heading = points[i].heading_deg;
    if (std::isnan(heading)) heading = travel_heading(points, i, options);
    if (std::isnan(heading)) heading = last;
    headings.push_back(heading);
    last = heading;
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].heading_deg = headings[i];
}

}  // namespace roadstereo::io
