#include "find_damage_or_warn.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// Whether the floor of a damage lies where the searched disparities end.
bool ends_search(const Damage& damage, const DamageMap& map, const FrameResult& frame) {
  constexpr double margin_px = 1;
  constexpr std::size_t noteworthy = 20;  // one in so many pixels
  std::size_t at_end = 0;
  for (int v = damage.box_px[1]; v <= damage.box_px[3]; ++v) {
    for (int u = damage.box_px[0]; u <= damage.box_px[2]; ++u) {
      const bool inside = map.ids(u, v) == damage.id;
      at_end += inside && frame.disparity(u, v) < frame.shift.at(u, v) + margin_px ? 1U : 0U;
    }
  }
  return noteworthy * at_end > damage.pixels;
}

void warn_of_search_end(const DamageMap& map, const FrameResult& frame, bool calibrated,
                        std::vector<std::string>& warnings) {
  if (!frame.shift.enabled || frame.sigma.empty()) return;  // a given map was not searched
  std::string ids;
  for (const Damage& damage : map.damages) {
    if (damage.kind != DamageKind::depression || !ends_search(damage, map, frame)) continue;
    ids += (ids.empty() ? "" : ", ") + std::to_string(damage.id);
  }
  if (ids.empty()) return;
  warnings.push_back("search-end: the search ends at the floor of damage " + ids +
                     ", which may be deeper than measured; " + (calibrated ? "" : "give a calibration, or ") +
                     "raise perspective.max_damage_depth_m");
}

}  // namespace

bool find_damage_or_warn(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                         const DamageOptions& options, int threads, DamageMap& damage, PairHealth& health,
                         std::vector<std::string>& warnings) {
  const PairSpots spots = health.spots;
  health = {.spots = spots};
  try {
    find_damage(frame, calibration, options, threads, damage);
    health = measure_health(frame, damage, calibration, options, threads);
    health.spots = spots;
    withhold_severity(health, damage);
    warn_of_search_end(damage, frame, calibration.has_value(), warnings);
    for (const HealthFinding& finding : health.findings()) warnings.push_back(finding.id + ": " + finding.text);
    return true;
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    damage = make_empty_damage_map(frame.disparity.width(), frame.disparity.height(), error.what());
    warnings.push_back(std::string("no-damage: damage detection failed: ") + error.what());
    return false;
  }
}

}  // namespace roadstereo::cli
