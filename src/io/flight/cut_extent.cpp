#include "io/flight/cut_extent.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::io {
namespace {

/// Whether two depths are equal within three standard errors.
bool agree_in_depth(const Measurement& one, const Measurement& other) {
  constexpr double max_sigmas = 3;
  return std::abs(one.value - other.value) <= max_sigmas * std::hypot(one.std_error, other.std_error);
}

/// Area of a damage of which the largest sighting shows `largest_m2`: that and what only others cover, but no more than
/// the largest one goes on as wide as it is, since the outlines of many frames together are wider than each.
double area_of(const OutlineUnion& covered, const OutlineUnion& largest, double largest_m2) {
  const std::array<double, 2> axis = covered.axis();
  const double by_area = largest_m2 + covered.area_m2() - largest.area_m2();
  const double by_length = largest_m2 * covered.extent_m(axis) / largest.extent_m(axis);
  return std::max(largest_m2, std::min(by_area, by_length));
}

/// Extends a measurement in one frame to an area that is larger by that factor, at least 1, and as deep.
void enlarge(double growth, double length_m, DamageMetrics& metrics) {
  for (Measurement* const measured : {&metrics.area_m2, &metrics.volume_m3}) {
    *measured = {growth * measured->value, growth * measured->std_error};
  }
  metrics.diameter_m *= std::sqrt(growth);
  metrics.length_m = std::max(metrics.length_m, length_m);
  if (metrics.unit == DistressUnit::metre) {
    metrics.quantity = metrics.length_m;
  } else if (metrics.unit == DistressUnit::square_metre ||
             metrics.quantity != 1) {  // a large pothole counts as several
    metrics.quantity *= growth;
  }
}

}  // namespace

void CutExtent::add(const Damage& seen, bool is_best, const std::optional<FlightPose>& pose,
                    const std::vector<std::array<double, 3>>& outline_m) {
  const bool agrees = !covered_ || agree_in_depth(seen.max_depth(), depth_);
  if (is_best) {
    depth_ = seen.max_depth();
    if (!agrees) {
      covered_.reset();
      largest_.reset();
    }
  }
  if (!outline_m.empty() && (is_best || agrees)) cover(seen.metrics->area_m2.value, *pose, outline_m);
}

void CutExtent::cover(double area_m2, const FlightPose& pose, const std::vector<std::array<double, 3>>& outline_m) {
  if (!covered_) {
    covered_.emplace();
    to_road_ = inverse(pose.road_to_world);
    piece_ = pose.piece;
  }
  if (pose.piece != piece_) return;
  Outline outline;
  for (const auto& point : outline_m) {
    const auto on_road = transform_point(to_road_, point);
    outline.push_back({on_road[0], on_road[1]});
  }
  covered_->add(outline);
  if (largest_ && area_m2 <= largest_m2_) return;
  largest_.emplace().add(outline);
  largest_m2_ = area_m2;
}

Damage CutExtent::extended(const Damage& measured) const {
  Damage damage = measured;
  const double in_frame_m2 = measured.metrics->area_m2.value;
  if (!largest_ || !(in_frame_m2 > 0)) return damage;
  enlarge(std::max(1.0, area_of(*covered_, *largest_, largest_m2_) / in_frame_m2), covered_->extent_m(covered_->axis()),
          *damage.metrics);
  return damage;
}

}  // namespace roadstereo::io
