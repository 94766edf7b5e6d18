#include "find_damage_or_warn.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cli {

bool find_damage_or_warn(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                         const DamageOptions& options, int threads, DamageMap& damage,
                         std::vector<std::string>& warnings) {
  try {
    find_damage(frame, calibration, options, threads, damage);
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
