#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// A cut through a damage: what stands below (positive) or above (negative) the undamaged road along a straight line of
/// the image. The undamaged road is at depth 0 all along. One entry per pixel of the line, in all four lists.
struct CrossSection {
  bool metric = false;                    ///< whether positions are metres; else pixels
  std::vector<std::array<int, 2>> pixel;  ///< (u, v)
  std::vector<double> position;           ///< where the line of sight meets the undamaged road, from the first pixel
  std::vector<double> depth;              ///< measured, in the unit of `DamageMap::depth`; NaN in holes
  std::vector<double> filled;  ///< the same with what was interpolated in the holes; NaN where nothing is known
};

/// The cut through the deepest pixel along the long axis of the damage, with undamaged road at both ends as far as the
/// image shows it. `disparity` (ℓ, pixels, NaN invalid, may be empty) has the map's size; its NaN are the holes.
/// Without a calibration that is all it is used for, so that ℓ' does as well. Positions are metres when the map is
/// metric, disparity and calibration are there, and intact road is near. Throws Error when the sizes differ or the
/// deepest pixel lies outside the map.
CrossSection cross_section(const DamageMap& map, const Damage& damage, ImageView<const float> disparity = {},
                           const std::optional<StereoCalibration>& calibration = {});

}  // namespace roadstereo
