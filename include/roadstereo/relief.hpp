#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// The surface of a damage and its surroundings as a grid of points, row by row as in the image.
/// Metric: where the lines of sight meet the undamaged road, x to the camera's right and y forward, metres; else
/// pixels, y up in the image. Both from the middle of the grid.
struct Relief {
  bool metric = false;  ///< whether x and y are metres
  Image<float> x, y;
  Image<float> depth;            ///< in the unit of `DamageMap::depth`; NaN where nothing is known
  Image<std::uint8_t> measured;  ///< 255 where the depth was measured, 0 where it was interpolated or is unknown
};

/// The relief of the damage's box and a margin around it, at most `most_points` (2 … 1000) points a side. `disparity`
/// and `calibration` as for `cross_section`. Throws Error when the sizes differ.
Relief damage_relief(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                     const std::optional<StereoCalibration>& calibration, int most_points);

}  // namespace roadstereo
