#include "evaluate/damage_regions.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "json_text.hpp"

namespace roadstereo::cli {

Table confidence_table(const std::vector<FoundRegion>& regions) {
  constexpr std::array<double, 7> bounds{0, 0.1, 0.3, 0.5, 0.7, 0.9, 1};
  Table table{"Confidence: share of the regions, candidates included, that are damage",
              {{"confidence", "confidence"},
               {"regions", "regions"},
               {"mean confidence", "mean_confidence"},
               {"damage", "damage_share"}},
              {}};
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    double count = 0, confidence = 0, damage = 0;
    for (const FoundRegion& region : regions) {
      const bool is_last = k + 2 == bounds.size();
      if (region.damage.confidence < bounds[k] || (!is_last && region.damage.confidence >= bounds[k + 1])) continue;
      ++count;
      confidence += region.damage.confidence;
      damage += region.is_damage ? 1 : 0;
    }
    const double share = count > 0 ? damage / count : std::nan("");
    table.rows.push_back({Cell(fmt::format("{:.1f} to {:.1f}", bounds[k], bounds[k + 1])), Cell(count, 0),
                          Cell(count > 0 ? confidence / count : std::nan(""), 2), Cell(share, 2)});
  }
  return table;
}

nlohmann::ordered_json regions_json(const std::vector<FoundRegion>& regions) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FoundRegion& region : regions) {
    const DamageEvidence& evidence = region.damage.evidence;
    list.push_back({{"frame", region.frame},
                    {"kind", name_of(region.damage.kind)},
                    {"pixels", region.damage.pixels},
                    {"significance", json_number(evidence.significance)},
                    {"contrast_sigmas", json_number(evidence.contrast_sigmas)},
                    {"road_share", json_number(evidence.road_share)},
                    {"border_share", json_number(evidence.border_share)},
                    {"unseen_share", json_number(evidence.unseen_share)},
                    {"surface_significance", json_number(evidence.surface_significance)},
                    {"range_vote", json_number(evidence.range_vote)},
                    {"specular_excess", json_number(evidence.specular_excess)},
                    {"texture_share", json_number(evidence.texture_share)},
                    {"pixel_significance", json_number(evidence.pixel_significance)},
                    {"likely_wall_slope", json_number(evidence.likely_wall_slope)},
                    {"extent", json_number(evidence.extent)},
                    {"rut_significance", json_number(evidence.rut_significance)},
                    {"clutter", json_number(evidence.clutter)},
                    {"confidence", json_number(region.damage.confidence)},
                    {"is_damage", region.is_damage}});
  }
  return list;
}

}  // namespace roadstereo::cli
