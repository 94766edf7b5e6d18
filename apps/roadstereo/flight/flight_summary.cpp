#include "flight/flight_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/degrees.hpp"

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
    inspected += std::isfinite(frame.noise_px) ? 1 : 0;
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
