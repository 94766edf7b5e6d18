#include "roadstereo/map_inventory.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "core/log_odds.hpp"
#include "core/order_statistics.hpp"
#include "damage/distress.hpp"
#include "damage/smoothing_error.hpp"
#include "mapping/finding_groups.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// A figure of one sighting. `common` is the part of its standard error that all sightings share.
struct Figure {
  Measurement measured;
  double common = 0;
};

/// Mean with inverse variances; the common part of the errors does not shrink. Errors grow with the value, so that a
/// sighting that is too small would weigh most: each counts as that of the median value.
Measurement fuse(const std::vector<Figure>& figures, double view_factor) {
  constexpr double min_share = 0.05;  // of the variance, for the part that shrinks
  std::vector<double> values;
  values.reserve(figures.size());
  for (const Figure& figure : figures) values.push_back(figure.measured.value);
  const double typical = upper_median(values);
  double weight = 0, sum = 0, common = 0;
  for (const Figure& figure : figures) {
    const double scale = figure.measured.value > 0 ? typical / figure.measured.value : 1;
    const double error = scale * figure.measured.std_error, of_all = scale * figure.common;
    const double variance = error * error, own = std::max(variance - of_all * of_all, min_share * variance);
    weight += 1 / own;
    sum += figure.measured.value / own;
    common += of_all * of_all / own;
  }
  const auto n = static_cast<double>(figures.size());
  return {sum / weight, std::sqrt(common / weight + std::min(n, view_factor) / weight)};
}

/// What a frame tells of a place, whatever is there: pixels on a square metre of it over the square of their noise.
double information_of(const Damage& damage) {
  const DamageMetrics& m = *damage.metrics;
  const double noise_m = m.resolvable_depth_m;  // to scale
  const double information = static_cast<double>(damage.pixels) / (m.area_m2.value * noise_m * noise_m);
  return std::isfinite(information) && information > 0 ? information : 1;
}

/// First sighting of every frame: a whole one if there is one, then the surest.
std::vector<const Damage*> one_per_frame(const std::vector<const DamageSighting*>& sightings) {
  std::set<std::pair<int, int>> frames;
  std::vector<const Damage*> first;
  for (const DamageSighting* sighting : sightings) {
    if (frames.insert({sighting->pass, sighting->frame}).second) first.push_back(&sighting->found.damage);
  }
  return first;
}

/// Confidence of agreeing frames: the mean of the log-odds, weighted by what each frame tells of the place, and what
/// the root of the number of independent views adds to the log of the significance. A frame that measures the place
/// without a finding tells as much as the sighting that tells least; it counts as the least confident one, and none as
/// less.
double joint_confidence(const std::vector<const Damage*>& seen, int views, double view_factor) {
  constexpr double least_confidence = 0.05, per_log_significance = 2.15;
  double sum = 0, all = 0, most = 0, least = HUGE_VAL;
  for (const Damage* damage : seen) {
    const double weight = information_of(*damage);
    sum += weight * log_odds(std::max(least_confidence, damage->confidence));
    all += weight;
    most = std::max(most, weight);
    least = std::min(least, weight);
  }
  const double independent = std::max(1.0, all / most / view_factor);
  const double silent = least * std::max(0.0, static_cast<double>(views) - static_cast<double>(seen.size()));
  const double mean = (sum + silent * log_odds(least_confidence)) / (all + silent);
  return probability_of(mean + per_log_significance * 0.5 * std::log(independent));
}

/// Confidence of a finding in the map, which `views` frames measure. Each independent frame of those without a sighting
/// counts against it, by the confidence that the damage would have in one frame, where noise is larger by the root of
/// the number of independent frames: what all of them must have seen, and none has, is an error of the map. A sighting
/// that is less confident than that counts in proportion.
double confidence_in_map(const Damage& in_map, int views, const std::vector<const Damage*>& seen, double view_factor) {
  const double independent = std::max(1.0, views / view_factor);
  DamageEvidence in_frame = in_map.evidence;
  in_frame.significance /= std::sqrt(independent);
  const double expected = in_frame.confidence();
  double confirmed = 0;
  for (const Damage* damage : seen) confirmed += damage->confidence < expected ? damage->confidence / expected : 1;
  if (views <= confirmed) return in_map.confidence;
  const double silent = independent * (views - confirmed) / views;
  return probability_of(log_odds(in_map.confidence) + silent * std::log1p(-expected));
}

/// Median number of frames that measure the cells of a footprint.
int views_of(const MapCells& footprint, const RoadMap& map) {
  constexpr std::size_t max_samples = 50;
  const double per_cell = footprint_m / map.options().cell_m;
  std::vector<double> views;
  const std::size_t step = std::max<std::size_t>(1, footprint.size() / max_samples);
  for (std::size_t k = 0; k < footprint.size(); k += step) {
    const auto cell = [&](int index) { return static_cast<int>(std::floor((index + 0.5) * per_cell)); };
    views.push_back(map.read({cell(footprint[k][0]), cell(footprint[k][1]), 1, 1}).views(0, 0));
  }
  return views.empty() ? 0 : static_cast<int>(upper_median(views));
}

/// Best finding of a group: of the map, else the sighting that is whole and has the smallest error.
const MapDamage& best_of(const FindingGroup& group) {
  if (group.in_map != nullptr) return *group.in_map;
  const auto best = std::min_element(group.sightings.begin(), group.sightings.end(), [](auto* a, auto* b) {
    const Damage &one = a->found.damage, &other = b->found.damage;
    return std::tuple(one.cut_by_border, one.metrics->max_depth_m.std_error) <
           std::tuple(other.cut_by_border, other.metrics->max_depth_m.std_error);
  });
  return (*best)->found;
}

/// Whether the fused depth is resolved, or that of a finding by its noise alone (`DamageEvidence::depth_significance`).
bool is_depth_resolved(const FindingGroup& group, const Measurement& fused) {
  return fused.is_resolved() || (group.in_map != nullptr && group.in_map->damage.evidence.is_depth_resolved()) ||
         std::any_of(group.sightings.begin(), group.sightings.end(),
                     [](auto* one) { return one->found.damage.evidence.is_depth_resolved(); });
}

/// Distress that the most confidence speaks for: a frame knows the direction of the road, the map does not.
Distress distress_of(const std::vector<const Damage*>& seen, Distress otherwise) {
  std::map<Distress, double> votes;
  for (const Damage* damage : seen) votes[damage->metrics->distress] += damage->confidence;
  const auto most = std::max_element(votes.begin(), votes.end(),
                                     [](const auto& one, const auto& other) { return one.second < other.second; });
  return most == votes.end() ? otherwise : most->first;
}

/// Whether most frames have withheld the severity, since their depths are not to be trusted (withhold_severity).
bool is_withheld(const std::vector<const Damage*>& seen, const SeverityScheme& scheme) {
  const auto withheld = std::count_if(seen.begin(), seen.end(), [&](const Damage* damage) {
    const SeverityTable* const table = scheme.find(damage->metrics->distress);
    return table != nullptr && !table->classes.empty() && damage->metrics->severity == Severity::unknown;
  });
  return 2 * withheld > static_cast<std::ptrdiff_t>(seen.size());
}

/// Area of a damage of which there are only parts: that of all findings together, at least that of the best one.
Measurement area_of_all(const Damage& best, const MapCells& footprint) {
  const Measurement& of_best = best.metrics->area_m2;
  const double area = static_cast<double>(footprint.size()) * footprint_m * footprint_m;
  if (!best.cut_by_border || !(area > of_best.value) || !(of_best.value > 0)) return of_best;
  return {area, of_best.std_error * area / of_best.value};
}

void require_metrics(const MapDamage& found) {
  if (!found.damage.metrics)
    fail("damage ", found.damage.id, " has no metric values; only measured damages are joined");
}

RoadDamageRecord record_of(const FindingGroup& group, const RoadMap& map, const DamageOptions& options) {
  const double view_factor = map.view_factor();
  // What is hardly seen is hardly measured: such sightings count only where there are no others.
  const bool any_confident = std::any_of(group.sightings.begin(), group.sightings.end(), [&](auto* one) {
    return one->found.damage.confidence >= options.min_confidence && !one->found.damage.cut_by_border;
  });
  RoadDamageRecord record;
  record.best = best_of(group);
  record.best.footprint = group.footprint;
  record.found_in_map = group.in_map != nullptr;
  record.views = views_of(group.footprint, map);
  std::set<int> passes;
  std::vector<Figure> depth, mean_depth, area, volume;
  for (const DamageSighting* sighting : group.sightings) {
    passes.insert(sighting->pass);
    const Damage& damage = sighting->found.damage;
    if (damage.cut_by_border || (any_confident && damage.confidence < options.min_confidence)) continue;
    const DamageMetrics& m = *damage.metrics;
    const SmoothingError smoothing(static_cast<double>(damage.pixels));
    depth.push_back({m.max_depth_m, smoothing.max_depth(m.max_depth_m.value)});
    mean_depth.push_back({m.mean_depth_m, smoothing.mean_depth(m.mean_depth_m.value)});
    volume.push_back({m.volume_m3, smoothing.volume(m.volume_m3.value)});
    area.push_back({m.area_m2, m.area_m2.std_error / std::numbers::sqrt2});
  }
  const std::vector<const Damage*> seen = one_per_frame(group.sightings);
  record.sightings = static_cast<int>(seen.size());
  record.passes = static_cast<int>(passes.size());
  DamageMetrics& best = *record.best.damage.metrics;
  best.distress = distress_of(seen, best.distress);
  const bool whole = !depth.empty();
  record.max_depth_m = whole ? fuse(depth, view_factor) : best.max_depth_m;
  record.mean_depth_m = whole ? fuse(mean_depth, view_factor) : best.mean_depth_m;
  record.area_m2 = whole ? fuse(area, view_factor) : area_of_all(record.best.damage, group.footprint);
  record.volume_m3 = whole ? fuse(volume, view_factor) : best.volume_m3;
  record.confidence = seen.empty() ? 0 : joint_confidence(seen, record.views, view_factor);
  if (group.in_map != nullptr) {
    record.confidence =
        std::max(record.confidence, confidence_in_map(group.in_map->damage, record.views, seen, view_factor));
  }
  DamageMetrics fused = best;
  fused.max_depth_m = record.max_depth_m;
  fused.mean_depth_m = record.mean_depth_m;
  fused.area_m2 = record.area_m2;
  fused.diameter_m = 2 * std::sqrt(record.area_m2.value / std::numbers::pi);
  const bool resolvable = is_depth_resolved(group, fused.max_depth_m) || fused.mean_depth_m.is_resolved();
  const bool at_least = std::ranges::all_of(seen, [](const Damage* damage) { return damage->ends_search; });
  grade(options.severity, {resolvable, at_least && !seen.empty()}, fused);
  if (is_withheld(seen, options.severity)) return record;
  record.severity_probabilities = fused.severity_probabilities;
  record.severity = fused.severity;
  return record;
}

}  // namespace

std::vector<RoadDamageRecord> join_damage(std::span<const DamageSighting> sightings, std::span<const MapDamage> in_map,
                                          const RoadMap& map, const DamageOptions& options) {
  options.validate();
  for (const DamageSighting& sighting : sightings) require_metrics(sighting.found);
  for (const MapDamage& found : in_map) require_metrics(found);
  std::vector<RoadDamageRecord> records;
  for (const FindingGroup& group : group_findings(sightings, in_map, options.min_confidence)) {
    RoadDamageRecord record = record_of(group, map, options);
    const bool is_damage = record.confidence >= options.min_confidence && is_depth_resolved(group, record.max_depth_m);
    if (is_damage) records.push_back(std::move(record));
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a.max_depth_m.value > b.max_depth_m.value; });
  int id = 0;
  for (RoadDamageRecord& record : records) record.id = ++id;
  return records;
}

}  // namespace roadstereo
