#include "find_damage_or_warn.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

void warn_of_search_end(const DamageMap& map, bool calibrated, std::vector<std::string>& warnings) {
  std::string ids;
  for (const Damage& damage : map.damages) {
    if (!damage.ends_search) continue;
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
    warn_of_search_end(damage, calibration.has_value(), warnings);
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
