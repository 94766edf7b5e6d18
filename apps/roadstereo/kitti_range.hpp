#pragma once

#include <cstddef>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// A disparity map that can be stored as KITTI PNG.
struct KittiRange {
  Image<float> disparity;  ///< values out of range are NaN
  std::size_t lost = 0;    ///< number of values out of range
  std::size_t valid = 0;   ///< number of valid values
};

/// Removes values that 16 bits in steps of 1/256 px cannot store: outside 0 … 255.99 px.
KittiRange fit_kitti_range(ImageView<const float> disparity);

}  // namespace roadstereo::cli
