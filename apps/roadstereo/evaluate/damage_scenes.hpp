#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/table.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// One damage of a synthetic road and the region found on it.
struct SceneDamage {
  std::string scene;
  synth::DamageTruth truth;
  std::size_t pixels = 0;       ///< in the left image
  bool fully_visible = false;   ///< not cut by the border of the image
  double depth_px = 0;          ///< maximum depth as a difference of disparity
  double std_error_px = 0;      ///< of a depth measured there
  std::optional<Damage> found;  ///< the region that covers at least a third of the damage
  bool is_single = false;       ///< whether `found` covers no other damage
};

/// Damages and found regions of a set of scenes.
struct SceneResults {
  std::vector<SceneDamage> damages;
  std::size_t found = 0;            ///< regions
  std::size_t false_positives = 0;  ///< regions of which less than a third is damage
  int scenes = 0;
};

/// Match random scenes, from `first_seed` on, with a preset and score the damage found.
SceneResults score_scenes(int scenes, std::uint64_t first_seed, bool degraded, const std::string& preset);

/// Table of recall by kind: of all damages, and of those deeper than three standard errors.
Table detection_table(const SceneResults& results);

/// Table of the errors of depth, area and volume.
Table measurement_table(const SceneResults& results);

}  // namespace roadstereo::cli
