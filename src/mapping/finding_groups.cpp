#include "mapping/finding_groups.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "mapping/bounds_index.hpp"

namespace roadstereo {
namespace {

void add_cells(const MapCells& more, FindingGroup& group) {
  MapCells all;
  std::set_union(group.footprint.begin(), group.footprint.end(), more.begin(), more.end(), std::back_inserter(all),
                 cell_less);
  group.footprint = std::move(all);
  group.bounds = bounds_of(group.footprint);
}

void move_into(FindingGroup& from, FindingGroup& into) {
  add_cells(from.footprint, into);
  if (into.in_map == nullptr) into.in_map = from.in_map;
  into.sightings.insert(into.sightings.end(), from.sightings.begin(), from.sightings.end());
}

class Groups {
 public:
  /// Adds a finding to the group with the largest overlap, or to a new one. Returns the group.
  FindingGroup& add(const MapDamage& found, double min_confidence) {
    const CellBounds bounds = bounds_of(found.footprint);
    const std::size_t number = best_for(found, bounds);
    if (number == groups_.size()) {
      groups_.push_back({found.damage.kind, found.footprint, bounds, nullptr, {}});
    } else if (found.damage.confidence >= min_confidence) {
      add_cells(found.footprint, groups_[number]);
    }
    index_.add(number, groups_[number].bounds);
    return groups_[number];
  }

  /// Joins groups that have grown together: parts of one damage that later findings connect.
  void join_grown() {
    std::vector<char> joined(groups_.size(), 0);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (joined[i] != 0) continue;
      while (const auto other = grown_into(i, joined)) {
        move_into(groups_[*other], groups_[i]);
        joined[*other] = 1;
      }
    }
    std::vector<FindingGroup> kept;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (joined[i] == 0) kept.push_back(std::move(groups_[i]));
    }
    groups_ = std::move(kept);
  }

  std::vector<FindingGroup> take() { return std::move(groups_); }

 private:
  /// Number of the group with the largest overlap, or that of a new one.
  std::size_t best_for(const MapDamage& found, const CellBounds& bounds) const {
    std::size_t best = groups_.size();
    double max_share = min_overlap_share;
    for (const std::size_t i : index_.near(bounds)) {
      const FindingGroup& group = groups_[i];
      if (group.kind != found.damage.kind || !group.bounds.overlaps(bounds)) continue;
      const double share = overlap_share(group.footprint, found.footprint);
      if (share < max_share) continue;
      max_share = share;
      best = i;
    }
    return best;
  }

  /// The first group after `i`, of those not yet joined, that overlaps it much.
  std::optional<std::size_t> grown_into(std::size_t i, const std::vector<char>& joined) const {
    constexpr double min_share = 0.5;
    const FindingGroup& group = groups_[i];
    for (const std::size_t k : index_.near(group.bounds)) {
      if (k > i && joined[k] == 0 && group.kind == groups_[k].kind && group.bounds.overlaps(groups_[k].bounds) &&
          overlap_share(group.footprint, groups_[k].footprint) >= min_share)
        return k;
    }
    return std::nullopt;
  }

  std::vector<FindingGroup> groups_;
  BoundsIndex index_;  ///< of their bounds, also earlier ones
};

}  // namespace

std::vector<FindingGroup> group_findings(std::span<const DamageSighting> sightings, std::span<const MapDamage> in_map,
                                         double min_confidence) {
  const auto rank = [](const MapDamage& found) {
    return std::tuple(found.damage.cut_by_border, -found.damage.confidence);
  };
  std::vector<const MapDamage*> findings;
  for (const MapDamage& found : in_map) findings.push_back(&found);
  std::stable_sort(findings.begin(), findings.end(), [&](auto* a, auto* b) { return rank(*a) < rank(*b); });
  std::vector<const DamageSighting*> ordered;
  for (const DamageSighting& sighting : sightings) ordered.push_back(&sighting);
  std::stable_sort(ordered.begin(), ordered.end(), [&](auto* a, auto* b) { return rank(a->found) < rank(b->found); });
  Groups groups;
  for (const MapDamage* found : findings) {
    FindingGroup& group = groups.add(*found, min_confidence);
    if (group.in_map == nullptr) group.in_map = found;
  }
  for (const DamageSighting* sighting : ordered) {
    groups.add(sighting->found, min_confidence).sightings.push_back(sighting);
  }
  groups.join_grown();
  return groups.take();
}

}  // namespace roadstereo
