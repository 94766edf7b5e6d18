#include "synth/height_field.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::synth {
namespace {

/// Smallest root of a·t² + b·t + c in [from, to], without cancellation for small a; infinity if there is none.
double first_root(double a, double b, double c, double from, double to) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return no_hit;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double best = no_hit;
  const auto consider = [&](double t) {
    if (t >= from && t <= to) best = std::min(best, t);
  };
  if (q != 0) consider(c / q);
  if (a != 0) consider(q / a);
  return best;
}

}  // namespace

HeightField::HeightField(const Road& road) : camber_(road.camber), crest_(road.crest) {
  add_strips(road.kerbs);
  blobs_.reserve(road.blobs.size());
  cracks_.reserve(road.cracks.size());
  ruts_.reserve(road.ruts.size());
  for (const Blob& blob : road.blobs) add_blob(blobs_.emplace_back(blob), blob);
  for (const Crack& crack : road.cracks) add_crack(cracks_.emplace_back(crack));
  for (const Rut& rut : road.ruts) add_rut(ruts_.emplace_back(rut));
  for (const Piece& piece : pieces_) damage_box_.include(piece.box);
}

void HeightField::add_strips(const std::vector<Kerb>& kerbs) {
  std::vector<double> edges;
  for (const Kerb& kerb : kerbs) {
    edges.push_back(kerb.x_m);
    edges.push_back(kerb.x_m + kerb.width_m);
  }
  std::sort(edges.begin(), edges.end());
  strips_.push_back({-no_hit, edges.empty() ? no_hit : edges.front(), 0, 0});
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Strip strip{edges[i], i + 1 < edges.size() ? edges[i + 1] : no_hit, 0, 0};
    for (const Kerb& kerb : kerbs) {
      strip.rise += kerb.height_m * std::clamp((strip.x - kerb.x_m) / kerb.width_m, 0.0, 1.0);
      if (strip.x >= kerb.x_m && strip.x < kerb.x_m + kerb.width_m) strip.slope += kerb.height_m / kerb.width_m;
    }
    strips_.push_back(strip);
  }
}

void HeightField::add_blob(const BlobShape& shape, const Blob& blob) {
  const double radius = shape.max_radius() + box_margin_m;
  AxisAlignedBox ground;
  ground.lower = {blob.x_m - radius, blob.y_m - radius, 0};
  ground.upper = {blob.x_m + radius, blob.y_m + radius, 0};
  Piece piece;
  piece.blob = &shape;
  piece.box = box_over(ground, shape.min_offset(), shape.max_offset());
  piece.parts = {piece.box};
  piece.march_step = shape.march_step();
  pieces_.push_back(std::move(piece));
}

void HeightField::add_crack(const CrackShape& shape) {
  Piece piece;
  piece.crack = &shape;
  piece.march_step = shape.crack().width_m / 5;
  for (const CrackShape::Segment& segment : shape.segments()) {
    piece.parts.push_back(box_over(segment.ground, -shape.crack().depth_m, 0));
    piece.box.include(piece.parts.back());
  }
  pieces_.push_back(std::move(piece));
}

void HeightField::add_rut(const RutShape& shape) {
  Piece piece;
  piece.rut = &shape;
  piece.box = box_over(shape.ground(), -shape.rut().depth_m, 0);
  piece.parts = {piece.box};
  piece.march_step = shape.rut().width_m / 4;
  pieces_.push_back(std::move(piece));
}

AxisAlignedBox HeightField::box_over(const AxisAlignedBox& ground, double min_offset, double max_offset) const {
  // The undamaged road is monotonic between these positions, so that its extrema over the box are among them.
  double min_height = no_hit;
  double max_height = -no_hit;
  const auto consider = [&](double x) {
    if (x < ground.lower.x || x > ground.upper.x) return;
    for (const double y : {ground.lower.y, ground.upper.y, std::clamp(0.0, ground.lower.y, ground.upper.y)}) {
      min_height = std::min(min_height, undamaged(x, y));
      max_height = std::max(max_height, undamaged(x, y));
    }
  };
  consider(ground.lower.x);
  consider(ground.upper.x);
  for (const Strip& strip : strips_) {
    if (std::isfinite(strip.x)) consider(strip.x);
    if (camber_ != 0) consider(std::clamp(strip.slope / (2 * camber_), strip.x, strip.end));
  }
  AxisAlignedBox box = ground;
  box.lower.z = min_height + min_offset - box_margin_m;
  box.upper.z = max_height + max_offset + box_margin_m;
  return box;
}

const HeightField::Strip& HeightField::strip_at(double x) const {
  std::size_t i = strips_.size() - 1;
  while (i > 0 && x < strips_[i].x) --i;
  return strips_[i];
}

double HeightField::kerb_rise(double x) const {
  const Strip& strip = strip_at(x);
  return strip.slope == 0 ? strip.rise : strip.rise + strip.slope * (x - strip.x);
}

double HeightField::undamaged(double x, double y) const {
  return kerb_rise(x) - camber_ * x * x - crest_ * y * y;
}

double HeightField::undamaged_slope_x(double x) const {
  return strip_at(x).slope - 2 * camber_ * x;
}

DamageSample HeightField::damage(double x, double y) const {
  DamageSample all;
  for (const Piece& piece : pieces_) {
    const DamageSample one = piece.sample(x, y);
    all.offset += one.offset;
    all.light *= one.light;
    all.inside = all.inside || one.inside;
  }
  return all;
}

int HeightField::damage_id(double x, double y) const {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const AxisAlignedBox& box = pieces_[i].box;
    if (x < box.lower.x || x > box.upper.x || y < box.lower.y || y > box.upper.y) continue;
    if (pieces_[i].sample(x, y).inside) return static_cast<int>(i) + 1;
  }
  return 0;
}

double HeightField::strip_hit(const Strip& strip, const Ray& ray, double from, double to) const {
  const Vec3& o = ray.origin;
  const Vec3& d = ray.direction;
  const double edge = std::isfinite(strip.x) ? strip.x : 0;
  const double a = camber_ * d.x * d.x + crest_ * d.y * d.y;
  const double b = d.z + 2 * (camber_ * o.x * d.x + crest_ * o.y * d.y) - strip.slope * d.x;
  const double c = o.z + camber_ * o.x * o.x + crest_ * o.y * o.y - strip.rise - strip.slope * (o.x - edge);
  return first_root(a, b, c, from, to);
}

double HeightField::undamaged_hit(const Ray& ray, double from) const {
  if (strips_.size() == 1) return strip_hit(strips_.front(), ray, from, no_hit);
  // At an edge between strips rounding may put the root slightly outside both of them.
  constexpr double tolerance = 1e-13;
  double best = no_hit;
  for (const Strip& strip : strips_) {
    double enter = from;
    double leave = no_hit;
    if (!clip_axis(strip.x, strip.end, ray.origin.x, ray.direction.x, enter, leave)) continue;
    best = std::min(best, strip_hit(strip, ray, std::max(from, enter * (1 - tolerance)), leave * (1 + tolerance)));
  }
  return best;
}

}  // namespace roadstereo::synth
