#include "graph/track_observations.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

std::vector<TrackObservation> fixes_along(const PoseCurve& piece, const FixCurve& curve, double time_offset_s,
                                          double covered_offset_s, double max_gap_s) {
  const std::vector<PositionFix>& fixes = curve.fixes();
  const double from_s = piece.nodes().front().time_s + covered_offset_s;
  const double to_s = piece.nodes().back().time_s + covered_offset_s;
  auto fix = std::lower_bound(fixes.begin(), fixes.end(), from_s,
                              [](const PositionFix& one, double time_s) { return one.time_s < time_s; });
  std::vector<TrackObservation> found;
  for (; fix != fixes.end() && fix->time_s <= to_s; ++fix) {
    if (!piece.covers(fix->time_s - covered_offset_s, max_gap_s)) continue;
    const double time_s = fix->time_s - time_offset_s;
    const bool has_z = !std::isnan(fix->position_m[2]);
    const Eigen::Vector3d& position = curve.position(static_cast<std::size_t>(fix - fixes.begin()));
    found.push_back(
        {&piece, piece.nearest(time_s), fix->time_s, position, fix->horizontal_sd_m, fix->vertical_sd_m, has_z, false});
  }
  return found;
}

std::vector<TrackObservation> between_fixes(const PoseCurve& piece, const FixCurve& curve, double time_offset_s) {
  const std::vector<PositionFix>& fixes = curve.fixes();
  std::vector<TrackObservation> found;
  for (std::size_t node = 0; node < piece.nodes().size(); ++node) {
    const double time_s = piece.nodes()[node].time_s + time_offset_s;
    const std::optional<std::size_t> segment = curve.segment(time_s);
    if (!segment) continue;
    const PositionFix& fix = fixes[*segment];
    const bool has_z = !std::isnan(fix.position_m[2]) && !std::isnan(fixes[*segment + 1].position_m[2]);
    found.push_back(
        {&piece, node, time_s, curve.at(*segment, time_s), fix.horizontal_sd_m, fix.vertical_sd_m, has_z, true});
  }
  return found;
}

}  // namespace

std::vector<TrackObservation> observe_track(const std::vector<PoseCurve>& pieces, const FixCurve& curve,
                                            double time_offset_s, double covered_offset_s, double max_gap_s) {
  constexpr std::size_t least = 3;  // two tell no direction when they are near each other
  std::vector<TrackObservation> all;
  for (const PoseCurve& piece : pieces) {
    std::vector<TrackObservation> found = fixes_along(piece, curve, time_offset_s, covered_offset_s, max_gap_s);
    if (found.size() < least) found = between_fixes(piece, curve, time_offset_s);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace roadstereo
