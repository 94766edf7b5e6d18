#include "io/geo/track_outliers.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <utility>

namespace roadstereo::io {
namespace {

/// Whether the track comes back to `from` within the largest gap, at a fix after `index`.
bool comes_back(const TrackPoint& from, const std::vector<TrackPoint>& points, std::size_t index,
                const TrackOptions& options) {
  for (std::size_t i = index + 1; i < points.size() && points[i].time_s - from.time_s <= options.max_gap_s; ++i) {
    if (is_reachable(from, points[i])) return true;
  }
  return false;
}

/// Removes the stretches that are shorter than the longest one and that it cannot be reached from, or they from it.
void drop_other_stretches(std::vector<TrackPoint>& points, std::vector<TrackPoint>& outliers) {
  std::vector<std::vector<TrackPoint>> stretches;
  for (const TrackPoint& point : points) {
    if (stretches.empty() || !is_reachable(stretches.back().back(), point)) stretches.emplace_back();
    stretches.back().push_back(point);
  }
  const auto longest = std::max_element(stretches.begin(), stretches.end(),
                                        [](const auto& one, const auto& other) { return one.size() < other.size(); });
  points.clear();
  for (auto stretch = stretches.begin(); stretch != stretches.end(); ++stretch) {
    const bool before = stretch < longest;
    const bool reachable =
        before ? is_reachable(stretch->back(), longest->front()) : is_reachable(longest->back(), stretch->front());
    const bool kept = stretch == longest || stretch->size() == longest->size() || reachable;
    std::vector<TrackPoint>& side = kept ? points : outliers;
    side.insert(side.end(), stretch->begin(), stretch->end());
  }
  std::sort(outliers.begin(), outliers.end(),
            [](const TrackPoint& one, const TrackPoint& other) { return one.time_s < other.time_s; });
}

}  // namespace

bool is_reachable(const TrackPoint& from, const TrackPoint& to) {
  constexpr double max_speed_mps = 100, max_error_m = 10;
  double way_m = 0;
  GeographicLib::Geodesic::WGS84().Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m);
  return way_m <= max_speed_mps * (to.time_s - from.time_s) + max_error_m;
}

std::vector<TrackPoint> take_outliers(std::vector<TrackPoint>& points, const TrackOptions& options) {
  std::vector<TrackPoint> kept, outliers;
  kept.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!kept.empty() && !is_reachable(kept.back(), points[i])) {
      const bool has_next = i + 1 < points.size();
      if (comes_back(kept.back(), points, i, options) || (!has_next && kept.size() > 1)) {
        outliers.push_back(points[i]);
        continue;
      }
      if (kept.size() == 1 && has_next && is_reachable(points[i], points[i + 1])) {
        outliers.push_back(kept.back());
        kept.clear();
      }
    }
    kept.push_back(points[i]);
  }
  points = std::move(kept);
  drop_other_stretches(points, outliers);
  return outliers;
}

}  // namespace roadstereo::io
