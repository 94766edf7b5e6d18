#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Draws the outline, id and depth of every damage on the image (8 bit). Colours show the severity, or the kind if
/// there is no calibration; heights of protrusions have a plus sign. `white_level` as in to_grey. Throws Error if the
/// sizes differ.
Frame damage_overlay(const FrameView& picture, double white_level, const DamageMap& map);

}  // namespace roadstereo::io
#pragma GCC visibility pop
