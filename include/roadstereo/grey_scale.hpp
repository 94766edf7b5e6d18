#pragma once

#pragma GCC visibility push(default)
namespace roadstereo {

// Grey levels of matching: sixteenths of an 8-bit level, 0 … 4080, whatever the depth of the camera.
inline constexpr int grey_scale = 16;              ///< steps per 8-bit grey level
inline constexpr int grey_max = 255 * grey_scale;  ///< value of white

}  // namespace roadstereo
#pragma GCC visibility pop
