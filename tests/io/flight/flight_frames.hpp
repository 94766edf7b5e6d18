#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

// Frames of a flight, for tests.

namespace roadstereo::io {

/// A pothole with its box at that place.
inline Damage pothole(int u, int v, double depth_m = 0.05, double error_m = 0.001) {
  Damage damage;
  damage.id = 1;
  damage.confidence = 0.9;
  damage.pixels = 1600;
  damage.box_px = {u - 20, v - 20, u + 19, v + 19};
  damage.centroid_px = {u - 0.5, v - 0.5};
  damage.max_depth_px = {10 * depth_m, 0.1};
  damage.metrics.emplace();
  damage.metrics->max_depth_m = {depth_m, error_m};
  damage.metrics->severity = Severity::medium;
  return damage;
}

/// A tracked frame with those damages.
inline FlightFrame frame_of(std::int64_t index, std::vector<Damage> damages) {
  FlightFrame frame;
  frame.index = index;
  frame.name = std::to_string(index);
  frame.road_status = RoadStatus::tracked;
  frame.damages = std::move(damages);
  return frame;
}

}  // namespace roadstereo::io
