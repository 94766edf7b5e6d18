#include "kitti_range.hpp"

#include <cmath>
#include <limits>

namespace roadstereo::cli {

namespace {

constexpr float max_kitti_disparity = 255.99F;

}  // namespace

KittiRange fit_kitti_range(ImageView<const float> disparity) {
  KittiRange range;
  range.disparity.assign(disparity.width(), disparity.height(), std::numeric_limits<float>::quiet_NaN());
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const float d = disparity(u, v);
      if (std::isnan(d)) continue;
      ++range.valid;
      const bool fits = d >= 0 && d <= max_kitti_disparity;
      if (fits) range.disparity(u, v) = d;
      if (!fits) ++range.lost;
    }
  }
  return range;
}

}  // namespace roadstereo::cli
