#pragma once

#include <limits>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"

namespace roadstereo::synth {

inline constexpr double no_hit = std::numeric_limits<double>::infinity();

/// Margin of bounding boxes, so that the surface does not coincide with a face.
inline constexpr double box_margin_m = 1e-6;

/// Clip the interval [enter, leave] of a ray to a slab along one axis; false if nothing is left.
bool clip_axis(double lower, double upper, double origin, double direction, double& enter, double& leave);

/// Axis-aligned bounding box; empty by default.
struct AxisAlignedBox {
  Vec3 lower{no_hit, no_hit, no_hit};
  Vec3 upper{-no_hit, -no_hit, -no_hit};

  /// Extend the box to contain another one.
  void include(const AxisAlignedBox& other);
  /// Clip the interval [enter, leave] of the ray to the box (slab method); false if nothing is left.
  bool clip(const Ray& ray, double& enter, double& leave) const;
};

AxisAlignedBox bounds_of(const Box& box);

}  // namespace roadstereo::synth
