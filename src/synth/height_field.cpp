#include "synth/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "synth/hash.hpp"
#include "synth/noise.hpp"

namespace roadstereo::synth {
namespace {

/// Margin of bounding boxes, so that the surface does not coincide with a face.
constexpr double box_margin_m = 1e-6;

/// Clip the interval [enter, leave] of a ray to a slab along one axis.
bool clip_axis(double lower, double upper, double origin, double direction, double& enter, double& leave) {
  if (direction == 0) return origin >= lower && origin <= upper;
  const double a = (lower - origin) / direction;
  const double b = (upper - origin) / direction;
  enter = std::max(enter, std::min(a, b));
  leave = std::min(leave, std::max(a, b));
  return enter <= leave;
}

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

void AxisAlignedBox::include(const AxisAlignedBox& other) {
  lower = {std::min(lower.x, other.lower.x), std::min(lower.y, other.lower.y), std::min(lower.z, other.lower.z)};
  upper = {std::max(upper.x, other.upper.x), std::max(upper.y, other.upper.y), std::max(upper.z, other.upper.z)};
}

bool AxisAlignedBox::clip(const Ray& ray, double& enter, double& leave) const {
  return clip_axis(lower.z, upper.z, ray.origin.z, ray.direction.z, enter, leave) &&
         clip_axis(lower.y, upper.y, ray.origin.y, ray.direction.y, enter, leave) &&
         clip_axis(lower.x, upper.x, ray.origin.x, ray.direction.x, enter, leave);
}

AxisAlignedBox bounds_of(const Box& box) {
  AxisAlignedBox bounds;
  bounds.lower = {box.x_m - box.width_m / 2, box.y_m - box.length_m / 2, box.bottom_m};
  bounds.upper = {box.x_m + box.width_m / 2, box.y_m + box.length_m / 2, box.top_m};
  return bounds;
}

BlobShape::BlobShape(const Blob& blob) : blob_(blob), roughness_(0.8 * blob.irregularity) {
  // Harmonics start with the second: the first would only shift the centre.
  RandomSequence random(blob.seed);
  double sum = 0;
  std::array<double, harmonics> amplitude{};
  for (int k = 0; k < harmonics; ++k) {
    amplitude[static_cast<std::size_t>(k)] = random.uniform(0.3, 1.0) / (k + 2);
    sum += amplitude[static_cast<std::size_t>(k)];
  }
  for (std::size_t k = 0; k < harmonics; ++k) {
    const double phase = random.uniform(0, 2 * std::numbers::pi);
    cosine_share_[k] = blob.irregularity * amplitude[k] / sum * std::cos(phase);
    sine_share_[k] = blob.irregularity * amplitude[k] / sum * std::sin(phase);
  }
  max_radius_ = blob.radius_m * (1 + blob.irregularity);
  floor_radius_ = blob.radius_m * (1 - blob.irregularity) * (1 - blob.wall_share);
}

double BlobShape::outline_radius(double cosine, double sine) const {
  double c = cosine;
  double s = sine;
  double share = 1;
  for (std::size_t k = 0; k < harmonics; ++k) {
    const double next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
    share += cosine_share_[k] * c + sine_share_[k] * s;
  }
  return blob_.radius_m * share;
}

double BlobShape::floor_roughness(double x, double y) const {
  if (roughness_ == 0) return 0;
  const double coarse = 1.7 / blob_.radius_m;
  const double fine = 4.3 / blob_.radius_m;
  return roughness_ * (0.7 * gradient_noise(x * coarse, y * coarse, blob_.seed) +
                       0.3 * gradient_noise(x * fine, y * fine, ~blob_.seed));
}

DamageSample BlobShape::sample(double x, double y) const {
  const double dx = x - blob_.x_m;
  const double dy = y - blob_.y_m;
  const double r2 = dx * dx + dy * dy;
  if (r2 >= max_radius_ * max_radius_) return {};
  double share = 1;
  if (r2 > floor_radius_ * floor_radius_) {
    const double r = std::sqrt(r2);
    share = smooth_step((1 - r / outline_radius(dx / r, dy / r)) / blob_.wall_share);
    if (share == 0) return {};
  }
  return {-blob_.depth_m * share * (1 + floor_roughness(dx, dy)), blob_.depth_m > 0 ? 1 - 0.4 * share : 1.0, true};
}

double BlobShape::min_offset() const {
  return std::min(0.0, -blob_.depth_m * (1 + roughness_));
}

double BlobShape::max_offset() const {
  return std::max(0.0, -blob_.depth_m * (1 + roughness_));
}

double BlobShape::march_step() const {
  return blob_.radius_m * std::min(0.125, 0.4 * (1 - blob_.irregularity) * blob_.wall_share);
}

CrackShape::CrackShape(const Crack& crack) : crack_(crack) {
  RandomSequence random(crack.seed);
  const auto half_width = [&](std::size_t point) {
    const bool is_end = point == 0 || point + 1 == crack.points_m.size();
    return crack.width_m / 2 * (1 - crack.irregularity * (is_end ? 1 : random.uniform(0, 1)));
  };
  double start_width = half_width(0);
  const double margin = crack.width_m / 2 + box_margin_m;
  for (std::size_t i = 1; i < crack.points_m.size(); ++i) {
    const auto& a = crack.points_m[i - 1];
    const auto& b = crack.points_m[i];
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    AxisAlignedBox ground;
    ground.lower = {std::min(a[0], b[0]) - margin, std::min(a[1], b[1]) - margin, 0};
    ground.upper = {std::max(a[0], b[0]) + margin, std::max(a[1], b[1]) + margin, 0};
    const double end_width = half_width(i);
    const double growth = end_width - start_width;
    segments_.push_back({a[0], a[1], dx, dy, 1 / (dx * dx + dy * dy), start_width, growth, ground});
    start_width = end_width;
  }
}

DamageSample CrackShape::sample(double x, double y) const {
  double min_distance2 = 1;  // squared distance from the polyline, relative to the half width there
  for (const Segment& segment : segments_) {
    if (x < segment.ground.lower.x || x > segment.ground.upper.x || y < segment.ground.lower.y ||
        y > segment.ground.upper.y) {
      continue;
    }
    const double px = x - segment.x;
    const double py = y - segment.y;
    const double along = std::clamp((px * segment.dx + py * segment.dy) * segment.inverse_length2, 0.0, 1.0);
    const double ex = px - along * segment.dx;
    const double ey = py - along * segment.dy;
    const double half_width = segment.half_width + along * segment.half_width_growth;
    min_distance2 = std::min(min_distance2, (ex * ex + ey * ey) / (half_width * half_width));
  }
  if (min_distance2 >= 1) return {};
  const double share = 1 - std::sqrt(min_distance2);
  return {-crack_.depth_m * share, 1 - 0.8 * smooth_step(1.5 * share), true};
}

RutShape::RutShape(const Rut& rut)
    : rut_(rut),
      length_m_(std::hypot(rut.to_m[0] - rut.from_m[0], rut.to_m[1] - rut.from_m[1])),
      along_x_((rut.to_m[0] - rut.from_m[0]) / length_m_),
      along_y_((rut.to_m[1] - rut.from_m[1]) / length_m_) {}

DamageSample RutShape::sample(double x, double y) const {
  const double dx = x - rut_.from_m[0], dy = y - rut_.from_m[1];
  const double across = (dx * along_y_ - dy * along_x_) / (rut_.width_m / 2);
  const double along = dx * along_x_ + dy * along_y_;
  const double from_end = std::min(along, length_m_ - along);
  if (std::abs(across) >= 1 || from_end <= 0) return {};
  return {-rut_.depth_m * (1 - across * across) * smooth_step(from_end / rut_.width_m), 1, true};
}

AxisAlignedBox RutShape::ground() const {
  const double across_x = std::abs(along_y_) * rut_.width_m / 2 + box_margin_m;
  const double across_y = std::abs(along_x_) * rut_.width_m / 2 + box_margin_m;
  AxisAlignedBox ground;
  ground.lower = {std::min(rut_.from_m[0], rut_.to_m[0]) - across_x, std::min(rut_.from_m[1], rut_.to_m[1]) - across_y,
                  0};
  ground.upper = {std::max(rut_.from_m[0], rut_.to_m[0]) + across_x, std::max(rut_.from_m[1], rut_.to_m[1]) + across_y,
                  0};
  return ground;
}

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
