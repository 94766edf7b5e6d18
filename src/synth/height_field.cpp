#include "synth/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "synth/hash.hpp"
#include "synth/noise.hpp"

namespace roadstereo::synth {
namespace {

/// Boxes are this much larger than the damage, so that its surface never lies on a face.
constexpr double box_margin_m = 1e-6;

bool clip_axis(double low, double high, double origin, double direction, double& enter, double& leave) {
  if (direction == 0) return origin >= low && origin <= high;
  const double a = (low - origin) / direction;
  const double b = (high - origin) / direction;
  enter = std::max(enter, std::min(a, b));
  leave = std::min(leave, std::max(a, b));
  return enter <= leave;
}

/// Smallest root of a·t² + b·t + c in [from, to]. Computed so that nothing cancels when a is tiny.
double first_root(double a, double b, double c, double from, double to) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return no_hit;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double best = no_hit;
  const auto offer = [&](double t) {
    if (t >= from && t <= to) best = std::min(best, t);
  };
  if (q != 0) offer(c / q);
  if (a != 0) offer(q / a);
  return best;
}

}  // namespace

void Box::include(const Box& other) {
  low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
  high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y), std::max(high.z, other.high.z)};
}

bool Box::clip(const Ray& ray, double& enter, double& leave) const {
  return clip_axis(low.z, high.z, ray.origin.z, ray.direction.z, enter, leave) &&
         clip_axis(low.y, high.y, ray.origin.y, ray.direction.y, enter, leave) &&
         clip_axis(low.x, high.x, ray.origin.x, ray.direction.x, enter, leave);
}

BlobShape::BlobShape(const Blob& blob) : blob_(blob), roughness_(0.8 * blob.irregularity) {
  // The first harmonic would only move the centre: they start with the second.
  Draws draws(blob.seed);
  double sum = 0;
  std::array<double, harmonics> amplitude{};
  for (int k = 0; k < harmonics; ++k) {
    amplitude[static_cast<std::size_t>(k)] = draws.uniform(0.3, 1.0) / (k + 2);
    sum += amplitude[static_cast<std::size_t>(k)];
  }
  for (std::size_t k = 0; k < harmonics; ++k) {
    const double phase = draws.uniform(0, 2 * std::numbers::pi);
    cosine_share_[k] = blob.irregularity * amplitude[k] / sum * std::cos(phase);
    sine_share_[k] = blob.irregularity * amplitude[k] / sum * std::sin(phase);
  }
  largest_radius_ = blob.radius_m * (1 + blob.irregularity);
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
  if (r2 >= largest_radius_ * largest_radius_) return {};
  double share = 1;
  if (r2 > floor_radius_ * floor_radius_) {
    const double r = std::sqrt(r2);
    share = smooth_step((1 - r / outline_radius(dx / r, dy / r)) / blob_.wall_share);
    if (share == 0) return {};
  }
  return {-blob_.depth_m * share * (1 + floor_roughness(dx, dy)), blob_.depth_m > 0 ? 1 - 0.4 * share : 1.0, true};
}

double BlobShape::lowest() const {
  return std::min(0.0, -blob_.depth_m * (1 + roughness_));
}

double BlobShape::highest() const {
  return std::max(0.0, -blob_.depth_m * (1 + roughness_));
}

double BlobShape::march_step() const {
  return blob_.radius_m * std::min(0.125, 0.4 * (1 - blob_.irregularity) * blob_.wall_share);
}

CrackShape::CrackShape(const Crack& crack) : crack_(crack) {
  Draws draws(crack.seed);
  const auto half_width = [&](std::size_t point) {
    const bool end = point == 0 || point + 1 == crack.points_m.size();
    return crack.width_m / 2 * (1 - crack.irregularity * (end ? 1 : draws.uniform(0, 1)));
  };
  double start_width = half_width(0);
  const double reach = crack.width_m / 2 + box_margin_m;
  for (std::size_t i = 1; i < crack.points_m.size(); ++i) {
    const auto& a = crack.points_m[i - 1];
    const auto& b = crack.points_m[i];
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    Box ground;
    ground.low = {std::min(a[0], b[0]) - reach, std::min(a[1], b[1]) - reach, 0};
    ground.high = {std::max(a[0], b[0]) + reach, std::max(a[1], b[1]) + reach, 0};
    const double end_width = half_width(i);
    const double growth = end_width - start_width;
    segments_.push_back({a[0], a[1], dx, dy, 1 / (dx * dx + dy * dy), start_width, growth, ground});
    start_width = end_width;
  }
}

DamageSample CrackShape::sample(double x, double y) const {
  double nearest2 = 1;  // squared distance from the line, as a share of the half width there
  for (const Segment& segment : segments_) {
    if (x < segment.ground.low.x || x > segment.ground.high.x || y < segment.ground.low.y ||
        y > segment.ground.high.y) {
      continue;
    }
    const double px = x - segment.x;
    const double py = y - segment.y;
    const double along = std::clamp((px * segment.dx + py * segment.dy) * segment.inverse_length2, 0.0, 1.0);
    const double ex = px - along * segment.dx;
    const double ey = py - along * segment.dy;
    const double half_width = segment.half_width + along * segment.half_width_growth;
    nearest2 = std::min(nearest2, (ex * ex + ey * ey) / (half_width * half_width));
  }
  if (nearest2 >= 1) return {};
  const double share = 1 - std::sqrt(nearest2);
  return {-crack_.depth_m * share, 1 - 0.8 * smooth_step(1.5 * share), true};
}

HeightField::HeightField(const Road& road) : camber_(road.camber) {
  add_strips(road.kerbs);
  blobs_.reserve(road.blobs.size());
  cracks_.reserve(road.cracks.size());
  for (const Blob& blob : road.blobs) add_blob(blobs_.emplace_back(blob), blob);
  for (const Crack& crack : road.cracks) add_crack(cracks_.emplace_back(crack));
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
  const double reach = shape.largest_radius() + box_margin_m;
  Box ground;
  ground.low = {blob.x_m - reach, blob.y_m - reach, 0};
  ground.high = {blob.x_m + reach, blob.y_m + reach, 0};
  Piece piece;
  piece.blob = &shape;
  piece.box = box_over(ground, shape.lowest(), shape.highest());
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

Box HeightField::box_over(const Box& ground, double lowest, double highest) const {
  // The undamaged road is monotonic between these places, so that its extremes over the box are among them.
  double bottom = no_hit;
  double top = -no_hit;
  const auto offer = [&](double x) {
    if (x < ground.low.x || x > ground.high.x) return;
    bottom = std::min(bottom, undamaged(x));
    top = std::max(top, undamaged(x));
  };
  offer(ground.low.x);
  offer(ground.high.x);
  for (const Strip& strip : strips_) {
    if (std::isfinite(strip.x)) offer(strip.x);
    if (camber_ != 0) offer(std::clamp(strip.slope / (2 * camber_), strip.x, strip.end));
  }
  Box box = ground;
  box.low.z = bottom + lowest - box_margin_m;
  box.high.z = top + highest + box_margin_m;
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

double HeightField::undamaged(double x) const {
  return kerb_rise(x) - camber_ * x * x;
}

double HeightField::undamaged_slope(double x) const {
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
    const Box& box = pieces_[i].box;
    if (x < box.low.x || x > box.high.x || y < box.low.y || y > box.high.y) continue;
    if (pieces_[i].sample(x, y).inside) return static_cast<int>(i) + 1;
  }
  return 0;
}

double HeightField::strip_hit(const Strip& strip, const Ray& ray, double from, double to) const {
  const Vec3& o = ray.origin;
  const Vec3& d = ray.direction;
  const double edge = std::isfinite(strip.x) ? strip.x : 0;
  const double a = camber_ * d.x * d.x;
  const double b = d.z + 2 * camber_ * o.x * d.x - strip.slope * d.x;
  const double c = o.z + camber_ * o.x * o.x - strip.rise - strip.slope * (o.x - edge);
  return first_root(a, b, c, from, to);
}

double HeightField::undamaged_hit(const Ray& ray, double from) const {
  if (strips_.size() == 1) return strip_hit(strips_.front(), ray, from, no_hit);
  // Strips meet at edges where rounding may push the root a little outside of both: allow for that.
  constexpr double slack = 1e-13;
  double best = no_hit;
  for (const Strip& strip : strips_) {
    double enter = from;
    double leave = no_hit;
    if (!clip_axis(strip.x, strip.end, ray.origin.x, ray.direction.x, enter, leave)) continue;
    best = std::min(best, strip_hit(strip, ray, std::max(from, enter * (1 - slack)), leave * (1 + slack)));
  }
  return best;
}

}  // namespace roadstereo::synth
