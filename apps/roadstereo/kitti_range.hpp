#pragma once

#include <cstddef>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// A disparity map that fits a KITTI PNG.
struct KittiRange {
  Image<float> disparity;  ///< values that do not fit are NaN
  std::size_t lost = 0;    ///< how many did not fit
  std::size_t valid = 0;   ///< how many there were
};

/// Leaves out what 16 bits in steps of 1/256 px cannot hold: negative disparities and those above 255.99 px.
KittiRange fit_kitti_range(ImageView<const float> disparity);

}  // namespace roadstereo::cli
