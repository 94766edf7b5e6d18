#include "damage/specular_excess.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "damage/block_votes.hpp"
#include "damage/rectified_right_image.hpp"
#include "damage/sampling_step.hpp"
#include "roadstereo/grey_scale.hpp"

namespace roadstereo {
namespace {

/// Mean grey levels of windows of both images, structure of arrays.
struct Brightness {
  std::vector<double> left, right;
};

/// Means of every second pixel of every second row of windows of 11×11 pixels, clipped to the image, along the measured
/// disparities.
class WindowMeans {
 public:
  explicit WindowMeans(const DamageInput& input)
      : input_(input), right_(input.right, input.shift ? input.shift->misalignment : Misalignment{}) {}

  /// Add those around (u, v), unless less than half of the window is known.
  void add(int u, int v, Brightness& to) const {
    constexpr int radius = 5, step = 2;
    const int u1 = std::min(u + radius, input_.grey.width() - 1), v1 = std::min(v + radius, input_.grey.height() - 1);
    double left = 0, right = 0;
    int pixels = 0, count = 0;
    for (int y = std::max(v - radius, 0); y <= v1; y += step) {
      const float* const disparity = input_.disparity_in_images().row(y);
      for (int x = std::max(u - radius, 0); x <= u1; x += step) {
        ++pixels;
        const double at = x - double{disparity[x]};
        if (!std::isfinite(at)) continue;
        const float grey = right_(at, y, right_.row(at, y));
        if (std::isnan(grey)) continue;
        left += input_.grey(x, y);
        right += double{grey};
        ++count;
      }
    }
    if (2 * count < pixels) return;
    to.left.push_back(left / count);
    to.right.push_back(right / count);
  }

 private:
  const DamageInput& input_;
  RectifiedRightImage right_;
};

/// Means of at most about `max_windows` windows on a regular grid of the box, where the damage `id` is; 0: the road.
Brightness brightness_of(const WindowMeans& means, const DamageMap& maps, int id, const PixelBox& box,
                         double max_windows) {
  constexpr int min_step = 4;
  const int step = sampling_step(box, max_windows, min_step);
  Brightness brightness;
  for (int v = box.v0; v <= box.v1; v += step) {
    for (int u = box.u0; u <= box.u1; u += step) {
      if (maps.ids(u, v) == id && maps.road(u, v) != 0) means.add(u, v, brightness);
    }
  }
  return brightness;
}

}  // namespace

double specular_excess(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box) {
  constexpr double max_inside = 64, max_around = 256;
  constexpr int min_margin = 16;
  constexpr std::size_t min_around = 8;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!has_blocks(input)) return unknown;
  const WindowMeans means(input);
  const Brightness inside = brightness_of(means, maps, id, box, max_inside);
  const int margin = min_margin + std::max(box.width(), box.height()) / 2;
  const PixelBox around_box{std::max(0, box.u0 - margin), std::max(0, box.v0 - margin),
                            std::min(input.grey.width() - 1, box.u1 + margin),
                            std::min(input.grey.height() - 1, box.v1 + margin)};
  Brightness around = brightness_of(means, maps, 0, around_box, max_around);
  if (inside.left.empty() || around.left.size() < min_around) return unknown;
  const double road = central_median(around.left), gain = road / central_median(around.right);
  if (!(road > 0 && std::isfinite(gain))) return unknown;
  const double white = grey_max * std::min(1.0, gain);  // what is brighter is white in one image only
  double sum = 0;
  for (std::size_t k = 0; k < inside.left.size(); ++k) {
    const double left = std::min(inside.left[k], white), right = std::min(gain * inside.right[k], white);
    const double excess = std::min(std::abs(left - right), std::max(0.0, std::max(left, right) - road)) / road;
    sum += excess * excess;
  }
  return std::sqrt(sum / static_cast<double>(inside.left.size()));
}

}  // namespace roadstereo
