#pragma once

#include <vector>

#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// First intersection of a ray with the scene.
struct Hit {
  double depth = no_hit;     ///< infinity if there is none
  bool near_damage = false;  ///< false: no damage changes the road there
  const Box* box = nullptr;  ///< the box that was hit; null: the road
};

/// Ray casting against a height field and boxes: closed form for boxes and the undamaged road, ray marching and
/// Ridders' root finding near damage. Keeps scratch memory; use one per thread.
class RayCaster {
 public:
  /// Both must outlive the ray caster.
  RayCaster(const HeightField& field, const std::vector<Box>& boxes);

  /// First intersection, with the depth accurate to a relative `tolerance`; 0: to floating-point precision.
  Hit first_hit(const Ray& ray, double tolerance);

  /// Combined effect, at a point near the last ray, of the damages whose boxes that ray crosses.
  DamageSample damage_near_last_ray(double x, double y) const;

 private:
  /// Interval of depths inside a box.
  struct Span {
    double enter;
    double leave;
  };

  Hit road_hit(const Ray& ray, double tolerance);
  /// Find the damages and the spans that the ray crosses, by increasing depth.
  void collect_spans(const Ray& ray);
  /// Height of the ray above the surface.
  double clearance(const Ray& ray, double depth) const;
  /// First intersection inside a span by ray marching; infinity if there is none.
  double march(const Ray& ray, const Span& span, double tolerance) const;
  /// Root of the clearance between two depths by Ridders' method.
  double find_root(const Ray& ray, double above, double below, double tolerance) const;

  const HeightField& field_;
  const std::vector<Box>& boxes_;
  std::vector<AxisAlignedBox> box_bounds_;
  std::vector<const HeightField::Piece*> active_;
  std::vector<Span> spans_;
  double march_step_ = 0;
};

}  // namespace roadstereo::synth
