#pragma once

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// A rectified pair and the rectified rig it belongs to. Every pixel has image content (no black borders).
struct RectifiedPair {
  Frame left;
  Frame right;
  StereoCalibration calibration;
};

/// Undistorts both frames and makes their rows agree. Throws Error when the frames do not have the rig's
/// size, or the rig cannot be rectified sideways (right camera above, below or left of the left one: the
/// sentence says which).
RectifiedPair rectify(const Frame& left, const Frame& right, const StereoRig& rig);

}  // namespace roadstereo::io
