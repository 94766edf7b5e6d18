#pragma once

#include <array>
#include <limits>
#include <vector>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"

namespace roadstereo::synth {

inline constexpr double no_hit = std::numeric_limits<double>::infinity();

/// A box with faces along the axes.
struct Box {
  Vec3 low{no_hit, no_hit, no_hit};
  Vec3 high{-no_hit, -no_hit, -no_hit};

  void include(const Box& other);
  /// Shrinks [enter, leave] to the part of the ray inside the box; false when none is left.
  bool clip(const Ray& ray, double& enter, double& leave) const;
};

/// What damage does to the road at a point.
struct DamageSample {
  double offset = 0;  ///< of the surface against the undamaged one, metres, upwards
  double light = 1;   ///< share of the light that gets in
  bool inside = false;
};

/// A pothole or a bump, ready to be sampled.
class BlobShape {
 public:
  explicit BlobShape(const Blob& blob);
  DamageSample sample(double x, double y) const;
  double largest_radius() const { return largest_radius_; }
  double lowest() const;  ///< bounds of the offset
  double highest() const;
  double march_step() const;  ///< along the ground, fine enough to meet every wall

 private:
  static constexpr int harmonics = 5;
  double outline_radius(double cosine, double sine) const;
  double floor_roughness(double x, double y) const;

  Blob blob_;
  std::array<double, harmonics> cosine_share_{};
  std::array<double, harmonics> sine_share_{};
  double largest_radius_ = 0;
  double floor_radius_ = 0;  ///< the floor reaches at least this far
  double roughness_ = 0;
};

/// A crack, ready to be sampled: a groove with the profile of a V along every segment of its line.
class CrackShape {
 public:
  struct Segment {
    double x, y, dx, dy, inverse_length2;
    double half_width, half_width_growth;  ///< at the start, and from there to the end
    Box ground;                            ///< its z is not used
  };

  explicit CrackShape(const Crack& crack);
  DamageSample sample(double x, double y) const;
  const std::vector<Segment>& segments() const { return segments_; }
  const Crack& crack() const { return crack_; }

 private:
  Crack crack_;
  std::vector<Segment> segments_;
};

/// The road's surface Z(X, Y).
class HeightField {
 public:
  /// A damage with the boxes outside which it leaves the road alone.
  struct Piece {
    const BlobShape* blob = nullptr;
    const CrackShape* crack = nullptr;
    Box box;                 ///< around all of it
    std::vector<Box> parts;  ///< tighter: one for a blob, one per segment of a crack
    double march_step = 0;

    DamageSample sample(double x, double y) const { return blob ? blob->sample(x, y) : crack->sample(x, y); }
  };

  explicit HeightField(const Road& road);
  HeightField(const HeightField&) = delete;  // pieces point to their shapes
  HeightField& operator=(const HeightField&) = delete;

  /// The road before the damage: camber and kerbs. It depends on x alone.
  double undamaged(double x) const;
  double undamaged_slope(double x) const;
  /// Sum of the kerbs' heights left of x: what the surface is longer than its projection, for the texture.
  double kerb_rise(double x) const;

  /// All damage together.
  DamageSample damage(double x, double y) const;
  double height(double x, double y) const { return undamaged(x) + damage(x, y).offset; }
  /// Id of the damage at a point: place in `pieces` plus 1, the first one where several overlap; 0 for none.
  int damage_id(double x, double y) const;

  const std::vector<Piece>& pieces() const { return pieces_; }
  const Box& damage_box() const { return damage_box_; }
  /// Depth at which the ray first meets the undamaged road at or behind `from`, where it must be above it.
  double undamaged_hit(const Ray& ray, double from) const;

 private:
  /// A strip of the road between two kerb edges: Z = −camber·X² + rise + slope·(X − x).
  struct Strip {
    double x;    ///< left edge
    double end;  ///< right edge
    double rise;
    double slope;
  };

  const Strip& strip_at(double x) const;
  double strip_hit(const Strip& strip, const Ray& ray, double from, double to) const;
  Box box_over(const Box& ground, double lowest, double highest) const;
  void add_strips(const std::vector<Kerb>& kerbs);
  void add_blob(const BlobShape& shape, const Blob& blob);
  void add_crack(const CrackShape& shape);

  double camber_ = 0;
  std::vector<Strip> strips_;
  std::vector<BlobShape> blobs_;
  std::vector<CrackShape> cracks_;
  std::vector<Piece> pieces_;
  Box damage_box_;
};

}  // namespace roadstereo::synth
