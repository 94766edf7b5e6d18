#pragma once

#include "roadstereo/synth.hpp"
#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// A point of the road as light leaves it.
struct SurfacePoint {
  double x = 0;
  double y = 0;
  double offset = 0;  ///< of the surface against the undamaged road, metres
  double light = 1;   ///< share of the sun and sky that reaches the point
  double slope_x = 0;
  double slope_y = 0;
};

/// What the road looks like: brightness in grey levels at exposure 1, the same from every direction. Detail
/// that a pixel of the given footprint could not resolve is left out, as the optics of a camera would.
class Texture {
 public:
  Texture(const Road& road, const HeightField& field);
  double grey(const SurfacePoint& point, const Footprint& footprint) const;

 private:
  double aggregate(double x, double y, double z, const Footprint& footprint) const;
  double octaves(double x, double y, double z, double footprint, std::uint32_t seed) const;
  double stones(double x, double y, double cell, double footprint, std::uint32_t seed) const;
  double patches(double x, double y, double footprint) const;
  double pavement(double x, double y, const Footprint& footprint) const;
  double verge(double x, double y, const Footprint& footprint) const;
  double paint(double x, double y, const Footprint& footprint) const;

  const HeightField& field_;
  double contrast_;
  bool lane_marking_;
  double kerb_x_;
  std::uint32_t seed_;
};

/// Brightness of the sky for a line of sight, grey levels.
double sky_grey(const Vec3& direction);

}  // namespace roadstereo::synth
