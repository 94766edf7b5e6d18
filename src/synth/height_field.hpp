#pragma once

#include <array>
#include <limits>
#include <vector>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"

namespace roadstereo::synth {

inline constexpr double no_hit = std::numeric_limits<double>::infinity();

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

/// Surface Z(X, Y) of a road.
class HeightField {
 public:
  /// Shape of a damage with bounding boxes.
  struct Piece {
    const BlobShape* blob = nullptr;
    const CrackShape* crack = nullptr;
    const RutShape* rut = nullptr;
    AxisAlignedBox box;
    std::vector<AxisAlignedBox> parts;  ///< tighter boxes: one for a blob or a rut, one per segment of a crack
    double march_step = 0;

    DamageSample sample(double x, double y) const {
      return blob ? blob->sample(x, y) : crack ? crack->sample(x, y) : rut->sample(x, y);
    }
  };

  explicit HeightField(const Road& road);
  HeightField(const HeightField&) = delete;  // pieces point to members
  HeightField& operator=(const HeightField&) = delete;

  /// Height of the undamaged road: camber, crest and kerbs.
  double undamaged(double x, double y) const;
  double undamaged_slope_x(double x) const;
  double undamaged_slope_y(double y) const { return -2 * crest_ * y; }
  /// Sum of the heights of the kerbs left of x: arc length of the surface in excess of x, for the texture.
  double kerb_rise(double x) const;

  /// Combined effect of all damages.
  DamageSample damage(double x, double y) const;
  double height(double x, double y) const { return undamaged(x, y) + damage(x, y).offset; }
  /// Id of the damage at a point, 1 + index in `pieces`; the first of several that overlap; 0: none. Scenery has an id.
  int damage_id(double x, double y) const;

  const std::vector<Piece>& pieces() const { return pieces_; }
  const AxisAlignedBox& damage_box() const { return damage_box_; }
  /// Depth of the first intersection of the ray with the undamaged road at a depth ≥ `from`; infinity if there is none.
  /// The ray must be above the road at `from`.
  double undamaged_hit(const Ray& ray, double from) const;

 private:
  /// Strip of the road between two kerb edges: Z = −camber·X² − crest·Y² + rise + slope·(X − x).
  struct Strip {
    double x;    ///< left edge
    double end;  ///< right edge
    double rise;
    double slope;
  };

  const Strip& strip_at(double x) const;
  double strip_hit(const Strip& strip, const Ray& ray, double from, double to) const;
  /// Box over a rectangle of the ground, for offsets of the surface between the two bounds.
  AxisAlignedBox box_over(const AxisAlignedBox& ground, double min_offset, double max_offset) const;
  void add_strips(const std::vector<Kerb>& kerbs);
  void add_blob(const BlobShape& shape, const Blob& blob);
  void add_crack(const CrackShape& shape);
  void add_rut(const RutShape& shape);

  double camber_ = 0;
  double crest_ = 0;
  std::vector<Strip> strips_;
  std::vector<BlobShape> blobs_;
  std::vector<CrackShape> cracks_;
  std::vector<RutShape> ruts_;
  std::vector<Piece> pieces_;
  AxisAlignedBox damage_box_;
};

}  // namespace roadstereo::synth
