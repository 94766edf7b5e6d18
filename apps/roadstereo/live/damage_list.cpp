#include "live/damage_list.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/io/flight_inventory.hpp"

namespace roadstereo::cli {
namespace {

double half_diagonal(const Damage& damage) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  return std::hypot(u1 - u0 + 1, v1 - v0 + 1) / 2;
}

/// Relative error of the depth.
double uncertainty(const Damage& damage) {
  const Measurement& depth = damage.metrics ? damage.metrics->max_depth_m : damage.max_depth_px;
  return depth.std_error / std::max(std::abs(depth.value), 1e-9);
}

bool better(const Damage& one, const Damage& other) {
  if (one.cut_by_border != other.cut_by_border) return !one.cut_by_border;
  return uncertainty(one) < uncertainty(other);
}

double distance(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

}  // namespace

/// A damage seen once is assumed to move like the others.
std::array<double, 2> DamageList::expected(const Track& track, Clock::time_point time) const {
  const double passed = seconds_between(track.seen, time);
  const std::array<double, 2>& speed = track.moved ? track.speed : common_speed_;
  return {track.last.centroid_px[0] + passed * speed[0], track.last.centroid_px[1] + passed * speed[1]};
}

DamageList::Track* DamageList::nearest(const Damage& damage, const LiveView& view, const std::vector<bool>& taken) {
  constexpr double min_radius_px = 12;
  Track* best = nullptr;
  double min_distance = HUGE_VAL;
  const double own_radius = std::max(min_radius_px, half_diagonal(damage));
  for (std::size_t i = 0; i < taken.size(); ++i) {
    Track& track = tracks_[i];
    if (taken[i] || track.last.kind != damage.kind || io::is_part_of_rut(track.last, damage)) continue;
    const double away =
        std::min(distance(expected(track, view.arrival), damage.centroid_px),
                 distance(track.last.centroid_px, damage.centroid_px));  // in case the motion has changed
    if (away <= std::max(own_radius, half_diagonal(track.last)) && away < min_distance) {
      best = &track;
      min_distance = away;
    }
  }
  return best;
}

void DamageList::follow(Track& track, const Damage& damage, const LiveView& view) {
  const double passed = seconds_between(track.seen, view.arrival);
  if (passed > 0) {
    track.speed = {(damage.centroid_px[0] - track.last.centroid_px[0]) / passed,
                   (damage.centroid_px[1] - track.last.centroid_px[1]) / passed};
    track.moved = true;
    if (!io::is_rut(damage)) common_speed_ = track.speed;
  }
  track.seen = view.arrival;
  track.last = damage;
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&track](const ListedDamage& listed) { return listed.id == track.id; });
  if (entry == entries_.end()) return;
  ++entry->views;
  if (!better(damage, entry->best)) return;
  entry->best = damage;
  entry->changed_in = view.number;
}

void DamageList::begin(const Damage& damage, const LiveView& view) {
  Track track;
  track.id = ++found_;
  track.seen = view.arrival;
  track.last = damage;
  tracks_.push_back(track);
  entries_.push_front({track.id, view.clock_s, view.number, 1, damage});
  if (entries_.size() > max_entries) entries_.pop_back();
}

void DamageList::add(const LiveView& view) {
  // Maximum time between two sightings of a damage: that of three views, at least.
  constexpr double min_memory_s = 1, min_memory_views = 3;
  const double since_last_s = last_view_ ? seconds_between(*last_view_, view.arrival) : 0;
  const double memory_s = std::max(min_memory_s, min_memory_views * (interval_s_ > 0 ? interval_s_ : since_last_s));
  interval_s_ = since_last_s;
  last_view_ = view.arrival;
  tracks_.erase(
      std::remove_if(tracks_.begin(), tracks_.end(),
                     [&](const Track& track) { return seconds_between(track.seen, view.arrival) > memory_s; }),
      tracks_.end());
  std::vector<bool> taken(tracks_.size(), false);
  for (const Damage& damage : view.damages) {
    if (Track* track = nearest(damage, view, taken)) {
      taken[static_cast<std::size_t>(track - tracks_.data())] = true;
      follow(*track, damage, view);
    } else {
      begin(damage, view);
    }
  }
}

}  // namespace roadstereo::cli
