// Regions that the search for damage found, judged by labels: for the calibration of the confidence.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/table.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo::cli {

/// Share of a damage that a region must cover, and of a region that must be damage.
inline constexpr double min_damage_share = 1.0 / 3;

/// A damage or candidate, and whether the labels agree.
struct FoundRegion {
  std::string frame;
  Damage damage;
  bool is_damage = false;  ///< at least a third of it is labelled
};

/// Damages and candidates of a frame. `labelled` is true at labelled pixels, W×H of the map. Candidates have no pixels
/// in the map: theirs are the labelled ones in the bounding box.
template <class Labelled>
std::vector<FoundRegion> found_regions(const std::string& frame, const DamageMap& map, const Labelled& labelled);

/// Table of the share of the regions that are damage, by confidence.
Table confidence_table(const std::vector<FoundRegion>& regions);

/// Array with one object per region: frame, kind, evidence, confidence, and whether it is damage.
nlohmann::ordered_json regions_json(const std::vector<FoundRegion>& regions);

template <class Labelled>
std::vector<FoundRegion> found_regions(const std::string& frame, const DamageMap& map, const Labelled& labelled) {
  std::vector<FoundRegion> regions;
  for (const std::vector<Damage>* list : {&map.damages, &map.candidates}) {
    for (const Damage& damage : *list) {
      const bool has_pixels = list == &map.damages;
      double count = 0;
      for (int v = damage.box_px[1]; v <= damage.box_px[3]; ++v) {
        for (int u = damage.box_px[0]; u <= damage.box_px[2]; ++u) {
          count += labelled(u, v) && (!has_pixels || map.ids(u, v) == damage.id) ? 1 : 0;
        }
      }
      regions.push_back({frame, damage, count >= min_damage_share * static_cast<double>(damage.pixels)});
    }
  }
  return regions;
}

}  // namespace roadstereo::cli
