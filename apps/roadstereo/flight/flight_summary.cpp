#include "flight/flight_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/degrees.hpp"
#include "finite_values.hpp"

namespace roadstereo::cli {

void FlightSummary::add(const io::FlightFrame& frame) {
  constexpr std::size_t max_reasons = 5;
  ++frames;
  health.add(frame);
  static_mask = frame.static_mask;
  good += frame.status == io::FrameStatus::good ? 1 : 0;
  rejected += frame.status == io::FrameStatus::rejected ? 1 : 0;
  failed += frame.status == io::FrameStatus::failed ? 1 : 0;
  if (frame.status == io::FrameStatus::good) {
    road_unknown += frame.road_status == RoadStatus::none ? 1 : 0;
    road_estimated += frame.road_status == RoadStatus::found || frame.road_status == RoadStatus::weak ? 1 : 0;
    if (std::isfinite(frame.noise_px)) add_view(frame);
    matching_ms.push_back(frame.matching_ms);
    damage_ms.push_back(frame.damage_ms);
    valid_share.push_back(frame.valid_share);
  } else if (reasons.size() < max_reasons) {
    reasons.push_back(frame.name + ": " + frame.reason);
  }
  if (std::isnan(first_time_s)) first_time_s = frame.time_s;
  if (std::isfinite(frame.time_s)) last_time_s = frame.time_s;
  curves.time.push_back(frame.time_s);
  curves.roll_deg.push_back(frame.roll_observable ? to_degrees(frame.roll_rad) : io::FlightFrame::unknown);
  curves.height_m.push_back(frame.height_m);
  curves.sigma_d_px.push_back(frame.sigma_d_px);
  pitch_deg.push_back(to_degrees(frame.pitch_rad));
}

void FlightSummary::add_view(const io::FlightFrame& frame) {
  ++inspected;
  untrusted += frame.health.depth_is_trusted() ? 0 : 1;
  views.push_back({frame.road, frame.height_m, frame.noise_px, frame.valid_share});
}

io::InspectionLimits FlightSummary::limits(const std::optional<StereoCalibration>& calibration,
                                           const DamageOptions& options) const {
  if (views.empty()) return {};
  io::InspectionLimits limits{doubts_of(health.findings()), ""};
  std::vector<double> depths_m, distances_m, noises_px;
  std::int64_t sparse = 0;
  for (const RoadView& view : views) {
    noises_px.push_back(view.noise_px);
    if (!calibration || calibration->width < 1) continue;
    sparse += doubts_of({}, view, calibration->width, calibration->height).empty() ? 0 : 1;
    const std::optional<ResolvedDepth> depth = resolved_depth(view, *calibration, options);
    if (!depth) continue;
    depths_m.push_back(depth->depth_m);
    distances_m.push_back(depth->distance_m);
  }
  if (limits.doubts.empty() && 2 * untrusted > inspected) {
    limits.doubts.push_back(fmt::format(
        "the depths cannot be trusted in {} of {} frames: see the warnings in frames.csv", untrusted, inspected));
  }
  if (2 * sparse > inspected) {
    limits.doubts.push_back(
        fmt::format("less than half of what shows the road has a disparity in {} of {} frames", sparse, inspected));
  }
  std::optional<ResolvedDepth> typical;
  if (!depths_m.empty()) typical = {median(depths_m), median(distances_m)};
  limits.limit = limit_text(typical, median(noises_px), options);
  return limits;
}

std::string FlightSummary::no_road_text() const {
  if (inspected == good) return {};
  return fmt::format("Damage could not be searched for in {} of {} frames, where no road was found or too little of it",
                     good - inspected, frames);
}

void FlightSummary::settle_times() {
  curves.in_seconds = !curves.time.empty() && std::all_of(curves.time.begin(), curves.time.end(),
                                                          [](double time) { return std::isfinite(time); });
  if (curves.in_seconds) {
    for (double& time : curves.time) time -= first_time_s;
  } else {
    std::iota(curves.time.begin(), curves.time.end(), 0.0);
  }
}

}  // namespace roadstereo::cli
