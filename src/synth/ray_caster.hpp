#pragma once

#include <vector>

#include "synth/height_field.hpp"

namespace roadstereo::synth {

/// Where a ray first meets the road.
struct Hit {
  double depth = no_hit;     ///< infinite when it never does
  bool near_damage = false;  ///< false: no damage changes the road there
};

/// Finds the first meeting of rays with the road. Keeps scratch memory: one per thread.
class RayCaster {
 public:
  explicit RayCaster(const HeightField& field) : field_(field) {}

  /// The depth is exact to `tolerance`, relative; 0 is as exact as the numbers are.
  Hit first_hit(const Ray& ray, double tolerance);

  /// All damage that the last ray came near, at a point of that ray's neighbourhood.
  DamageSample damage_near_last_ray(double x, double y) const;

 private:
  struct Span {
    double enter;
    double leave;
  };

  void collect(const Ray& ray);
  double clearance(const Ray& ray, double depth) const;
  double march(const Ray& ray, const Span& span, double tolerance) const;
  double refine(const Ray& ray, double above, double below, double tolerance) const;

  const HeightField& field_;
  std::vector<const HeightField::Piece*> active_;
  std::vector<Span> spans_;
  double march_step_ = 0;
};

}  // namespace roadstereo::synth
