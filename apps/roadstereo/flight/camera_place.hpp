#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/io/track.hpp"

namespace roadstereo::cli {

/// Where the camera of a frame was on the Earth.
struct CameraPlace {
  std::int64_t frame = 0;               ///< index in the source
  io::GeoPosition camera;               ///< heading: direction of the upper image border
  std::optional<io::GeoPosition> foot;  ///< of the perpendicular onto the road; absent without a road
};

}  // namespace roadstereo::cli
