#pragma once

#include <array>
#include <vector>

#include "roadstereo/synth.hpp"
#include "synth/axis_aligned_box.hpp"

namespace roadstereo::synth {

/// Effect of damage on the road at a point.
struct DamageSample {
  double offset = 0;    ///< height above the undamaged surface, metres
  double light = 1;     ///< share of the light that reaches the point, 0 … 1
  bool inside = false;  ///< whether the point belongs to a damage
};

/// Pothole or bump: outline of Fourier harmonics, smoothstep wall, noisy floor.
class BlobShape {
 public:
  explicit BlobShape(const Blob& blob);
  DamageSample sample(double x, double y) const;
  double max_radius() const { return max_radius_; }
  double min_offset() const;
  double max_offset() const;
  double march_step() const;  ///< for ray marching, along the ground: a fraction of the width of the wall

 private:
  static constexpr int harmonics = 5;
  double outline_radius(double cosine, double sine) const;
  double floor_roughness(double x, double y) const;

  Blob blob_;
  std::array<double, harmonics> cosine_share_{};
  std::array<double, harmonics> sine_share_{};
  double max_radius_ = 0;
  double floor_radius_ = 0;  ///< lower bound of the radius of the floor
  double roughness_ = 0;
};

/// Crack: a V-shaped groove along the segments of a polyline.
class CrackShape {
 public:
  struct Segment {
    double x, y, dx, dy, inverse_length2;
    double half_width, half_width_growth;  ///< at the start, and its increase to the end
    AxisAlignedBox ground;                 ///< z is not used
  };

  explicit CrackShape(const Crack& crack);
  DamageSample sample(double x, double y) const;
  const std::vector<Segment>& segments() const { return segments_; }
  const Crack& crack() const { return crack_; }

 private:
  Crack crack_;
  std::vector<Segment> segments_;
};

/// Rut: the section of a parabola along a line.
class RutShape {
 public:
  explicit RutShape(const Rut& rut);
  DamageSample sample(double x, double y) const;
  AxisAlignedBox ground() const;  ///< z is not used
  const Rut& rut() const { return rut_; }

 private:
  Rut rut_;
  double length_m_, along_x_, along_y_;  ///< of the line, and its direction
};

}  // namespace roadstereo::synth
