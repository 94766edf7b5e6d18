#include "synth/ray_caster.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::synth {

RayCaster::RayCaster(const HeightField& field, const std::vector<Box>& boxes) : field_(field), boxes_(boxes) {
  for (const Box& box : boxes) box_bounds_.push_back(bounds_of(box));
}

void RayCaster::collect_spans(const Ray& ray) {
  active_.clear();
  spans_.clear();
  march_step_ = no_hit;
  for (const HeightField::Piece& piece : field_.pieces()) {
    double enter = 0;
    double leave = no_hit;
    if (!piece.box.clip(ray, enter, leave)) continue;
    const std::size_t count_before = spans_.size();
    for (const AxisAlignedBox& part : piece.parts) {
      Span span{0, no_hit};
      if (part.clip(ray, span.enter, span.leave)) spans_.push_back(span);
    }
    if (spans_.size() == count_before) continue;
    active_.push_back(&piece);
    march_step_ = std::min(march_step_, piece.march_step);
  }
  std::sort(spans_.begin(), spans_.end(), [](const Span& a, const Span& b) { return a.enter < b.enter; });
}

DamageSample RayCaster::damage_near_last_ray(double x, double y) const {
  DamageSample all;
  for (const HeightField::Piece* piece : active_) {
    const DamageSample one = piece->sample(x, y);
    all.offset += one.offset;
    all.light *= one.light;
    all.inside = all.inside || one.inside;
  }
  return all;
}

double RayCaster::clearance(const Ray& ray, double depth) const {
  const Vec3 point = ray.at(depth);
  return point.z - field_.undamaged(point.x, point.y) - damage_near_last_ray(point.x, point.y).offset;
}

double RayCaster::find_root(const Ray& ray, double above, double below, double tolerance) const {
  // Ridders' method halves the bracket at least and converges quadratically where the surface is smooth.
  double above_clearance = clearance(ray, above);
  double below_clearance = clearance(ray, below);
  double last = no_hit;
  constexpr int max_steps = 80;
  for (int step = 0; step < max_steps && above_clearance > 0 && below_clearance < 0; ++step) {
    const double middle = 0.5 * (above + below);
    const double centre = clearance(ray, middle);
    if (middle == above || middle == below || centre == 0) return middle;
    const double guess =
        middle + (middle - above) * centre / std::sqrt(centre * centre - above_clearance * below_clearance);
    const double value = clearance(ray, guess);
    if (value == 0 || std::abs(guess - last) <= tolerance * guess || below - above <= tolerance * below) return guess;
    last = guess;
    const auto tighten = [&](double depth, double height) {
      if (depth <= above || depth >= below) return;
      if (height > 0) {
        above = depth;
        above_clearance = height;
      } else {
        below = depth;
        below_clearance = height;
      }
    };
    tighten(middle, centre);
    tighten(guess, value);
  }
  return above_clearance <= 0 ? above : below;
}

double RayCaster::march(const Ray& ray, const Span& span, double tolerance) const {
  const double ground_speed = std::hypot(ray.direction.x, ray.direction.y);
  const double length = (span.leave - span.enter) * ground_speed;
  constexpr double max_steps = 20000;
  const int steps = 1 + static_cast<int>(std::min(length / march_step_, max_steps));
  double above = span.enter;
  for (int i = 0; i <= steps; ++i) {
    const double depth = span.enter + (span.leave - span.enter) * i / steps;
    if (clearance(ray, depth) <= 0) return i == 0 ? depth : find_root(ray, above, depth, tolerance);
    above = depth;
  }
  return no_hit;
}

Hit RayCaster::first_hit(const Ray& ray, double tolerance) {
  Hit hit = road_hit(ray, tolerance);
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    double enter = 0;
    double leave = hit.depth;
    if (box_bounds_[i].clip(ray, enter, leave) && enter < hit.depth) hit = {enter, false, &boxes_[i]};
  }
  return hit;
}

Hit RayCaster::road_hit(const Ray& ray, double tolerance) {
  double undamaged = field_.undamaged_hit(ray, 0);
  double enter = 0;
  double leave = no_hit;
  if (field_.pieces().empty() || !field_.damage_box().clip(ray, enter, leave)) return {undamaged, false, nullptr};
  collect_spans(ray);
  for (std::size_t i = 0; i < spans_.size();) {
    Span span = spans_[i++];
    if (undamaged < span.enter) return {undamaged, false, nullptr};
    while (i < spans_.size() && spans_[i].enter <= span.leave) span.leave = std::max(span.leave, spans_[i++].leave);
    const double depth = march(ray, span, tolerance);
    if (depth < no_hit) return {depth, true, nullptr};
    // Inside the span damage replaces the undamaged road: search behind it.
    if (undamaged <= span.leave) undamaged = field_.undamaged_hit(ray, span.leave);
  }
  return {undamaged, false, nullptr};
}

}  // namespace roadstereo::synth
