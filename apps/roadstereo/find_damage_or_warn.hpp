#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/health.hpp"

namespace roadstereo::cli {

/// Finds the damage of a frame and measures its health. What is out of order becomes a warning; no damage is graded
/// whose depth cannot be trusted. If finding fails, e.g. because too few samples lie on one surface, `damage` becomes
/// an empty map that has the reason, and a warning is added. `health` keeps its spots. Returns whether it succeeded.
/// Throws SystemError.
bool find_damage_or_warn(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                         const DamageOptions& options, int threads, DamageMap& damage, PairHealth& health,
                         std::vector<std::string>& warnings);

}  // namespace roadstereo::cli
