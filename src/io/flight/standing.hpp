#pragma once

#include <optional>

#include "core/same_view.hpp"
#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

/// Whether a frame shows the road from the place of an earlier pose (is_same_view); false where one has no pose.
inline bool stands_at(const std::optional<FlightPose>& earlier, const FlightFrame& frame) {
  return earlier && frame.pose && earlier->piece == frame.pose->piece &&
         is_same_view(earlier->road_to_world, frame.pose->road_to_world, frame.height_m);
}

}  // namespace roadstereo::io
