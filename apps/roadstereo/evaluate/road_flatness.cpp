#include "evaluate/road_flatness.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// Call `visit(u, v, d)` for every valid disparity of the mask.
template <class Visit>
void for_each_road_pixel(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, const Visit& visit) {
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      if (mask(u, v) != 0 && !std::isnan(disparity(u, v))) visit(u, v, static_cast<double>(disparity(u, v)));
    }
  }
}

}  // namespace

DisparityPlane fit_without_roll(ImageView<const float> disparity, ImageView<const std::uint8_t> mask) {
  const double origin = disparity.height() / 2.0;  // near the data, to avoid cancellation
  double n = 0, sum_v = 0, sum_d = 0, sum_vv = 0, sum_vd = 0;
  for_each_road_pixel(disparity, mask, [&](int, int v, double d) {
    const double row = v - origin;
    n += 1;
    sum_v += row;
    sum_d += d;
    sum_vv += row * row;
    sum_vd += row * d;
  });
  const double determinant = n * sum_vv - sum_v * sum_v;
  if (determinant <= 0) fail("the road has disparities in fewer than two rows; it must have at least two");
  DisparityPlane plane;
  plane.a1 = (n * sum_vd - sum_v * sum_d) / determinant;
  plane.a0 = (sum_d - plane.a1 * sum_v) / n - plane.a1 * origin;
  return plane;
}

double transformed_deviation(ImageView<const float> disparity, ImageView<const std::uint8_t> mask,
                             const DisparityPlane& plane) {
  double n = 0, sum = 0, squares = 0;
  for_each_road_pixel(disparity, mask, [&](int u, int v, double d) {
    const double transformed = d - plane.disparity(u, v);
    n += 1;
    sum += transformed;
    squares += transformed * transformed;
  });
  return std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0));
}

}  // namespace roadstereo::cli
