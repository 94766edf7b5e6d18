#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "core/log_odds.hpp"
#include "core/order_statistics.hpp"
#include "io/flight/cut_extent.hpp"
#include "io/flight/outline_overlap.hpp"
#include "io/flight/place_index.hpp"
#include "io/flight/standing.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::io {
namespace {

/// Maximum number of frames between two sightings of a damage.
constexpr std::int64_t max_gap = 2;

/// Overlap of two sightings of one damage, as a fraction of the smaller one.
constexpr double min_overlap = 0.2;

/// Area on the road, or in the picture without a calibration.
double size_of(const Damage& damage) {
  return damage.metrics ? damage.metrics->area_m2.value : static_cast<double>(damage.pixels);
}

/// Whether the damage is measured better: not cut by the border; if it is, at least half as large as the largest such
/// sighting, else it is a splinter; then smaller error.
bool is_better(const Damage& one, const Damage& other, double largest_cut) {
  constexpr double min_share = 0.5;
  const auto rank = [&](const Damage& damage) {
    const bool splinter = damage.cut_by_border && size_of(damage) < min_share * largest_cut;
    return std::tuple(damage.cut_by_border, splinter, damage.max_depth().std_error);
  };
  return rank(one) < rank(other);
}

/// Overlap of two boxes after `box` is moved, as a fraction of the smaller one.
double overlap(const std::array<int, 4>& box, const std::array<double, 2>& move, const std::array<int, 4>& other) {
  const auto length = [](double first, double last) { return std::max(0.0, last - first + 1); };
  const double width =
      length(std::max(box[0] + move[0], double(other[0])), std::min(box[2] + move[0], double(other[2])));
  const double height =
      length(std::max(box[1] + move[1], double(other[1])), std::min(box[3] + move[1], double(other[3])));
  const double smaller = std::min(length(box[0], box[2]) * length(box[1], box[3]),
                                  length(other[0], other[2]) * length(other[1], other[3]));
  return width * height / smaller;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

bool is_taken(std::int64_t id, const std::vector<std::int64_t>& taken) {
  return std::find(taken.begin(), taken.end(), id) != taken.end();
}

/// Whether two sightings may be of one damage: of one kind, and not a rut and a pothole in it.
bool may_be_one(const Damage& one, const Damage& other) {
  return one.kind == other.kind && !is_part_of_rut(one, other);
}

/// Takes the measurement in a frame as the best one.
void measure(const FlightFrame& frame, const Damage& damage, RoadDamage& known) {
  known.frame = frame.index;
  known.frame_name = frame.name;
  known.time_s = frame.time_s;
  known.best = damage;
}

}  // namespace

bool is_rut(const Damage& damage) {
  return damage.metrics && damage.metrics->distress == Distress::rut;
}

bool is_part_of_rut(const Damage& one, const Damage& other) {
  constexpr double max_share = 0.25;
  const auto area = [](const Damage& of) {
    return static_cast<double>(of.box_px[2] - of.box_px[0] + 1) * (of.box_px[3] - of.box_px[1] + 1);
  };
  return is_rut(one) != is_rut(other) &&
         std::min(area(one), area(other)) < max_share * std::max(area(one), area(other));
}

FlightInventory::FlightInventory(double min_confidence)
    : min_confidence_(min_confidence), places_(std::make_unique<PlaceIndex>()) {}
FlightInventory::~FlightInventory() = default;
FlightInventory::FlightInventory(FlightInventory&&) noexcept = default;
FlightInventory& FlightInventory::operator=(FlightInventory&&) noexcept = default;

/// Outline of a damage of a frame in the world; none without a pose or an outline.
std::optional<FlightInventory::Place> FlightInventory::place_of(const Damage& damage,
                                                                const std::optional<FlightPose>& pose) {
  if (!pose || !damage.metrics || damage.metrics->outline_m.empty()) return {};
  Place place;
  place.piece = pose->piece;
  for (const auto& [x, y] : damage.metrics->outline_m) {
    place.outline_m.push_back(transform_point(pose->road_to_world, {x, y, 0}));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const auto& point : place.outline_m) place.centre_m[axis] += point[axis];
    place.centre_m[axis] /= static_cast<double>(place.outline_m.size());
  }
  for (const auto& point : place.outline_m) {
    place.radius_m = std::max(place.radius_m, distance(point, place.centre_m));
  }
  return place;
}

/// Returns the id of the known damage with the largest overlap on the road, or 0.
std::int64_t FlightInventory::seen_here(const Sighting& now, const FlightPose& pose, const Ids& taken) const {
  std::int64_t best = 0;
  double max_share = min_overlap;
  const RigidTransform world_to_road = inverse(pose.road_to_world);
  const auto share_of = [&](const std::optional<Place>& place) {
    if (!place || place->piece != now.place->piece) return 0.0;
    const double near = place->radius_m + now.place->radius_m;
    if (distance(place->centre_m, now.place->centre_m) > near) return 0.0;
    Outline outline;
    for (const auto& point : place->outline_m) {
      const auto on_road = transform_point(world_to_road, point);
      outline.push_back({on_road[0], on_road[1]});
    }
    return outline_overlap(outline, now.damage.metrics->outline_m);
  };
  for (const std::int64_t id : places_->near(now.place->piece, now.place->centre_m, now.place->radius_m)) {
    const Known& known = known_[static_cast<std::size_t>(id) - 1];
    const Sighting& last = known.last;
    if (!may_be_one(last.damage, now.damage) || is_taken(last.id, taken)) continue;
    const double share = std::max(share_of(last.place), share_of(known.best_place));
    if (share <= max_share) continue;
    max_share = share;
    best = last.id;
  }
  return best;
}

/// Returns the id of the recent sighting whose box overlaps most, or 0. While no damage has told the image motion, a
/// camera that stands still is as likely as one that goes on.
std::int64_t FlightInventory::seen_in_picture(const Sighting& now, const Ids& taken) const {
  std::int64_t best = 0;
  double max_share = min_overlap;
  for (const std::int64_t id : recent_) {
    const Sighting& last = known_[static_cast<std::size_t>(id) - 1].last;
    if (!is_recent(last) || !may_be_one(last.damage, now.damage) || is_taken(last.id, taken)) continue;
    if (now.place && last.place && now.place->piece == last.place->piece) continue;  // seen elsewhere
    const auto frames = static_cast<double>(sequence_ - last.sequence);
    const std::array<int, 4>& box = now.damage.box_px;
    double share = overlap(last.damage.box_px, {frames * motion_px_[0], frames * motion_px_[1]}, box);
    if (share <= min_overlap && !motion_known_) share = overlap(last.damage.box_px, {}, box);
    if (share <= max_share) continue;
    max_share = share;
    best = last.id;
  }
  return best;
}

/// Whether a damage was seen a few frames ago, and the image has not jumped since.
bool FlightInventory::is_recent(const Sighting& last) const {
  return last.sequence >= uncut_from_ && sequence_ - last.sequence <= max_gap + 1;
}

/// Stores the sightings for the next frames and updates the image motion from those seen before. A rut, which runs
/// through the picture, does not tell it.
void FlightInventory::remember(std::vector<Sighting> sightings) {
  std::vector<double> along_u, along_v;
  for (Sighting& now : sightings) {
    Sighting& last = known_[static_cast<std::size_t>(now.id) - 1].last;
    if (is_recent(last) && !is_rut(now.damage)) {
      const auto frames = static_cast<double>(now.sequence - last.sequence);
      along_u.push_back((now.damage.centroid_px[0] - last.damage.centroid_px[0]) / frames);
      along_v.push_back((now.damage.centroid_px[1] - last.damage.centroid_px[1]) / frames);
    }
    recent_.push_back(now.id);
    last = std::move(now);
  }
  std::sort(recent_.begin(), recent_.end());
  recent_.erase(std::unique(recent_.begin(), recent_.end()), recent_.end());
  std::erase_if(recent_, [&](std::int64_t id) {
    return sequence_ - known_[static_cast<std::size_t>(id) - 1].last.sequence > max_gap;
  });
  motion_known_ = !along_u.empty();
  if (motion_known_) motion_px_ = {upper_median(along_u), upper_median(along_v)};
}

/// Whether the frame begins a view.
bool FlightInventory::has_moved(const FlightFrame& frame) const {
  if (!frame.pose) return !view_from_;  // a truck that hides the road does not move the camera
  return !stands_at(view_from_, frame);
}

void FlightInventory::add_confidence(double confidence, Agreement& views) const {
  if (views.view != view_ && views.frames > 0) {
    constexpr std::size_t most = 2;
    const double mean = views.sum / views.frames;
    views.best.insert(std::upper_bound(views.best.begin(), views.best.end(), mean, std::greater<>()), mean);
    views.best.resize(std::min(views.best.size(), most));
    views.sum = views.frames = 0;
  }
  views.view = view_;
  views.sum += log_odds(confidence);
  ++views.frames;
}

bool FlightInventory::agree(const Agreement& views, std::int64_t sightings) const {
  if (sightings == 1) return true;
  const double last = views.sum / views.frames;
  if (views.best.empty()) return last >= log_odds(min_confidence_);
  const double other = views.best.size() > 1 ? std::max(views.best[1], last) : last;
  return views.best[0] + other >= 2 * log_odds(min_confidence_);
}

std::vector<std::int64_t> FlightInventory::add(const FlightFrame& frame) {
  ++sequence_;
  if (has_moved(frame)) {
    ++view_;
    view_from_ = frame.pose;
  }
  const bool has_road = frame.status == FrameStatus::good && frame.road_status != RoadStatus::none;
  if (has_road && had_road_ && frame.road_status != RoadStatus::tracked) uncut_from_ = sequence_;
  had_road_ = has_road;
  Ids ids;
  std::vector<Sighting> sightings;
  const auto add_one = [&](const Damage& damage, bool candidate) {
    Sighting now{0, sequence_, damage, place_of(damage, frame.pose)};
    if (now.place) now.id = seen_here(now, *frame.pose, ids);
    if (now.id == 0) now.id = seen_in_picture(now, ids);
    const bool is_new = now.id == 0;
    if (is_new) {
      RoadDamage& found = damages_.emplace_back();
      known_.emplace_back().extent = std::make_unique<CutExtent>();
      now.id = static_cast<std::int64_t>(damages_.size());
      found.id = now.id;
      found.first_frame = frame.index;
    }
    RoadDamage& on_road = damages_[static_cast<std::size_t>(now.id) - 1];
    Known& known = known_[static_cast<std::size_t>(now.id) - 1];
    Agreement& views = known.views;
    if (now.place) places_->add(now.id, now.place->piece, now.place->centre_m, now.place->radius_m);
    ++on_road.sightings;
    on_road.last_frame = frame.index;
    const bool first_damage = !candidate && !views.is_damage;
    const bool counts = is_new || first_damage || views.is_damage != candidate;
    if (first_damage) known.largest_cut = 0;
    if (counts && damage.cut_by_border) known.largest_cut = std::max(known.largest_cut, size_of(damage));
    const bool is_best = is_new || first_damage || (counts && is_better(damage, known.measured, known.largest_cut));
    if (is_best) {
      measure(frame, damage, on_road);
      known.measured = damage;
      known.best_place = now.place;
    }
    if (!candidate && known.measured.cut_by_border && known.measured.metrics) {
      known.extent->add(damage, is_best, frame.pose, now.place ? now.place->outline_m : Place().outline_m);
      on_road.best = known.extent->extended(known.measured);
    }
    views.is_damage = views.is_damage || !candidate;
    add_confidence(damage.confidence, views);
    on_road.candidate = !views.is_damage || !agree(views, on_road.sightings);
    ids.push_back(now.id);
    sightings.push_back(std::move(now));
  };
  for (const Damage& damage : frame.damages) add_one(damage, false);
  for (const Damage& candidate : frame.candidates) add_one(candidate, true);
  remember(std::move(sightings));
  return ids;
}

}  // namespace roadstereo::io
