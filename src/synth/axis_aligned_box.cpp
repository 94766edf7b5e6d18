#include "synth/axis_aligned_box.hpp"

#include <algorithm>

namespace roadstereo::synth {

bool clip_axis(double lower, double upper, double origin, double direction, double& enter, double& leave) {
  if (direction == 0) return origin >= lower && origin <= upper;
  const double a = (lower - origin) / direction;
  const double b = (upper - origin) / direction;
  enter = std::max(enter, std::min(a, b));
  leave = std::min(leave, std::max(a, b));
  return enter <= leave;
}

void AxisAlignedBox::include(const AxisAlignedBox& other) {
  lower = {std::min(lower.x, other.lower.x), std::min(lower.y, other.lower.y), std::min(lower.z, other.lower.z)};
  upper = {std::max(upper.x, other.upper.x), std::max(upper.y, other.upper.y), std::max(upper.z, other.upper.z)};
}

bool AxisAlignedBox::clip(const Ray& ray, double& enter, double& leave) const {
  return clip_axis(lower.z, upper.z, ray.origin.z, ray.direction.z, enter, leave) &&
         clip_axis(lower.y, upper.y, ray.origin.y, ray.direction.y, enter, leave) &&
         clip_axis(lower.x, upper.x, ray.origin.x, ray.direction.x, enter, leave);
}

AxisAlignedBox bounds_of(const Box& box) {
  AxisAlignedBox bounds;
  bounds.lower = {box.x_m - box.width_m / 2, box.y_m - box.length_m / 2, box.bottom_m};
  bounds.upper = {box.x_m + box.width_m / 2, box.y_m + box.length_m / 2, box.top_m};
  return bounds;
}

}  // namespace roadstereo::synth
