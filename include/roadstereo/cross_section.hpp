#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Depth profile of a damage along a straight line of the image. Depths are relative to the undamaged road: positive
/// below it, negative above it. All four lists have one entry per pixel of the line.
struct CrossSection {
  bool metric = false;                    ///< whether `position` is in metres; else pixels
  std::vector<std::array<int, 2>> pixel;  ///< (u, v)
  std::vector<double> position;           ///< distance on the undamaged road from the point at the first pixel
  std::vector<double> depth;              ///< measured depth, in the unit of `DamageMap::depth`; NaN in holes
  std::vector<double> filled;             ///< depth with interpolated holes; NaN where no depth is available
};

/// Extract the profile through the deepest pixel along the major axis of the damage, with a margin of undamaged road at
/// both ends where the image shows it. `disparity` is ℓ, pixels, NaN in its holes, of the size of the map, or empty.
/// Without a calibration only the holes are used, so that ℓ' may be given instead. Positions are in metres if the map
/// is metric, `disparity` and `calibration` are given, and at least 30 pixels of intact road surround the damage.
/// Throws Error when the sizes differ or the deepest pixel lies outside the map.
CrossSection extract_cross_section(const DamageMap& map, const Damage& damage, ImageView<const float> disparity = {},
                                   const std::optional<StereoCalibration>& calibration = {});

}  // namespace roadstereo
#pragma GCC visibility pop
