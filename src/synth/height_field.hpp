#pragma once

#include <vector>

#include "roadstereo/synth.hpp"
#include "synth/axis_aligned_box.hpp"
#include "synth/damage_shapes.hpp"

namespace roadstereo::synth {

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
