#include "find_damage_or_warn.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cli {

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
    for (const HealthFinding& finding : health.findings()) warnings.push_back(finding.id + ": " + finding.text);
    return true;
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    damage = make_empty_damage_map(frame.disparity.width(), frame.disparity.height(), "no road was found");
    warnings.push_back(std::string("no-damage: damage detection failed: ") + error.what());
    return false;
  }
}

}  // namespace roadstereo::cli
