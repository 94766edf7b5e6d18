#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// The picture (8 bit) with the outline of every damage, coloured by severity, or by kind without a calibration; beside
/// it id and depth, heights of protrusions with a plus. Throws Error when the sizes differ.
Frame damage_overlay(const FrameView& picture, const DamageMap& map);

}  // namespace roadstereo::io
