#include <algorithm>
#include <array>
#include <cmath>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "io/csv.hpp"
#include "io/damage_colours.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/road_segments.hpp"

namespace roadstereo::io {
namespace {

constexpr double max_segments = 1e7;  ///< 200 000 km of 20 m

/// Median of the finite values of the frames.
double median_of(const std::vector<const GeoFrame*>& frames, double GeoFrame::*member) {
  std::vector<double> values;
  for (const GeoFrame* frame : frames) {
    if (std::isfinite(frame->*member)) values.push_back(frame->*member);
  }
  return values.empty() ? std::nan("") : upper_median(values);
}

double station_of(std::int64_t index, std::span<const GeoFrame> frames) {
  const auto at = std::lower_bound(frames.begin(), frames.end(), index,
                                   [](const GeoFrame& frame, std::int64_t of) { return frame.index < of; });
  return at == frames.end() || at->index != index ? std::nan("") : at->station_m;
}

/// First and last station of a damage; both are that of its centroid unless the border cuts it in all frames: such a
/// one goes on from where the first frame shows it to where the last does, at most for its length.
std::array<double, 2> stations_of(const RoadDamage& damage, std::span<const GeoFrame> frames) {
  const double first_m = station_of(damage.first_frame, frames) + damage.ahead_m;
  const double last_m = station_of(damage.last_frame, frames) + damage.ahead_m;
  const Damage& best = damage.best;
  if (!best.cut_by_border || !best.metrics || !(first_m <= last_m)) return {damage.station_m, damage.station_m};
  return {first_m, std::min(last_m, first_m + best.metrics->length_m)};
}

}  // namespace

std::vector<RoadSegment> road_segments(std::span<const GeoFrame> frames, std::span<const RoadDamage> damages,
                                       double length_m) {
  if (!(length_m > 0)) fail("the length_m of road segments is ", length_m, "; it must be above 0");
  double end_m = -1;
  for (const GeoFrame& frame : frames) {
    if (std::isfinite(frame.station_m)) end_m = std::max(end_m, frame.station_m);
  }
  if (end_m < 0) return {};
  if (end_m / length_m >= max_segments) {
    fail("the length_m of road segments is ", length_m, "; ", end_m, " m of road are more than ", max_segments,
         " such");
  }
  const auto index_of = [length_m](double station_m) { return static_cast<std::size_t>(station_m / length_m); };
  const auto is_on_road = [end_m](double station_m) { return station_m >= 0 && station_m <= end_m; };
  const std::size_t count = index_of(end_m) + 1;
  // The camera may see road ahead of its last position, or behind its first one.
  const auto segment_at = [&](double station_m) { return index_of(std::clamp(station_m, 0.0, end_m)); };
  std::vector<RoadSegment> segments(count);
  std::vector<std::vector<const GeoFrame*>> members(count);
  std::vector<const RoadDamage*> worst(count);
  for (const GeoFrame& frame : frames) {
    if (is_on_road(frame.station_m)) members[segment_at(frame.station_m)].push_back(&frame);
  }
  for (const RoadDamage& damage : damages) {
    if (damage.candidate || !is_on_road(station_of(damage.frame, frames)) || std::isnan(damage.station_m)) continue;
    const auto [first_m, last_m] = stations_of(damage, frames);
    const std::size_t first = segment_at(first_m), last = segment_at(last_m);
    for (std::size_t i = first; i <= last; ++i) {
      ++segments[i].damages;
      if (damage.best.metrics) {
        segments[i].area_m2 += damage.best.metrics->area_m2.value / static_cast<double>(last - first + 1);
      }
      if (worst[i] == nullptr || is_worse(damage, *worst[i])) worst[i] = &damage;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    RoadSegment& segment = segments[i];
    segment.from_m = static_cast<double>(i) * length_m;
    segment.to_m = std::min(segment.from_m + length_m, std::max(end_m, segment.from_m));
    segment.frames = static_cast<std::int64_t>(members[i].size());
    segment.inspected = std::count_if(members[i].begin(), members[i].end(),
                                      [](const GeoFrame* frame) { return frame->damages.has_value(); });
    segment.worst = worst[i] == nullptr ? 0 : worst[i]->id;
    segment.roll_rad = median_of(members[i], &GeoFrame::roll_rad);
    segment.height_m = median_of(members[i], &GeoFrame::height_m);
  }
  return segments;
}

std::string segments_csv(std::span<const RoadSegment> segments, std::span<const RoadDamage> damages) {
  CsvLine line;
  for (const char* name : {"from_m", "to_m", "frames", "inspected", "damages", "area_m2", "worst", "worst_distress",
                           "worst_severity", "roll_deg", "height_m"}) {
    line.add(name);
  }
  std::string text = line.end();
  for (const RoadSegment& segment : segments) {
    line.add(segment.from_m, 1).add(segment.to_m, 1).add(segment.frames).add(segment.inspected);
    if (segment.inspected > 0) {
      line.add(segment.damages).add(segment.area_m2);
    } else {
      line.add_nothing().add_nothing();
    }
    const auto worst = std::find_if(damages.begin(), damages.end(),
                                    [&](const RoadDamage& damage) { return damage.id == segment.worst; });
    if (worst == damages.end()) {
      line.add_nothing().add_nothing().add_nothing();
    } else {
      line.add(worst->id).add(name_of(distress_of(worst->best))).add(name_of(severity_of(worst->best)));
    }
    text += line.add(to_degrees(segment.roll_rad)).add(segment.height_m).end();
  }
  return text;
}

}  // namespace roadstereo::io
