#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Depth of a damage and its surroundings on a grid, sampled row by row from the image. All four images have one size.
/// Coordinates are relative to the middle of the grid. Metric: intersections of the lines of sight with the undamaged
/// road, x to the camera's right, y forward, metres. Otherwise: pixels, y up in the image.
struct Relief {
  bool metric = false;  ///< whether x and y are in metres
  Image<float> x, y;
  Image<float> depth;            ///< in the unit of `DamageMap::depth`; NaN where no depth is available
  Image<std::uint8_t> measured;  ///< 255 where the depth was measured; 0 where it was interpolated or is missing
};

/// Extract the relief of the damage's bounding box with a margin, at most `max_points` (2 … 1000) samples per side.
/// `disparity` and `calibration` as for `extract_cross_section`. Throws Error when the sizes differ or `max_points` is
/// out of range.
Relief extract_relief(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                      const std::optional<StereoCalibration>& calibration, int max_points);

}  // namespace roadstereo
#pragma GCC visibility pop
