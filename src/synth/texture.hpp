#pragma once

#include "roadstereo/synth.hpp"
#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// Point on the surface of the road, for shading.
struct SurfacePoint {
  double x = 0;
  double y = 0;
  double offset = 0;  ///< height above the undamaged road, metres
  double light = 1;   ///< share of the light that reaches the point, 0 … 1
  double slope_x = 0;
  double slope_y = 0;
};

/// Procedural texture of a road with Lambertian shading: the same brightness from every direction. Detail finer than
/// the footprint of a pixel is filtered out analytically, as by the optics of a camera.
class Texture {
 public:
  Texture(const Road& road, const HeightField& field);
  /// Brightness of the road at exposure 1, 8-bit grey levels, without shade and water.
  double grey(const SurfacePoint& point, const Footprint& footprint) const;
  /// Brightness of a point on a face of a box, in pixels of `pixel_m`.
  double box_grey(const Box& box, const Vec3& point, double pixel_m) const;
  /// Share of the sun's light that the shadows of trees leave at a point.
  double shade(double x, double y) const;
  /// `grey` as seen through a film of water that mirrors the sky, for a line of sight.
  double wet_grey(double grey, const Vec3& point, const Vec3& direction) const;

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
  double paint_grey_;
  double shade_;
  double wet_share_;
  double verge_left_m_;
  double verge_right_m_;
  double kerb_x_;
  std::uint32_t seed_;
};

/// Brightness of the sky in a direction, 8-bit grey levels.
double sky_grey(const Vec3& direction);

}  // namespace roadstereo::synth
