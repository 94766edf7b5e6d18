#include "synth/damage_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/hash.hpp"
#include "synth/noise.hpp"

namespace roadstereo::synth {

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

}  // namespace roadstereo::synth
