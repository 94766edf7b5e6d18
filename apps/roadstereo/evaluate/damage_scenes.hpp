#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/table.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// One damage of a synthetic road and what was made of it.
struct SceneDamage {
  std::string scene;
  synth::DamageTruth truth;
  std::size_t pixels = 0;       ///< of the left image
  bool whole = false;           ///< the image shows all of it
  double depth_px = 0;          ///< its largest depth as a difference of disparity
  double std_error_px = 0;      ///< of a depth measured there
  std::optional<Damage> found;  ///< the damage that covers a third of it
  bool alone = false;           ///< `found` covers no other damage of the truth
};

/// All damages of a set of scenes, and the regions that are none of them.
struct SceneResults {
  std::vector<SceneDamage> damages;
  std::size_t found = 0;     ///< regions
  std::size_t invented = 0;  ///< regions of which less than a third is damage
  int scenes = 0;
};

/// Random scenes from `first_seed` on, matched with a preset.
SceneResults score_scenes(int scenes, std::uint64_t first_seed, bool degraded, const std::string& preset);

/// How many are found, by kind: of those deeper than three standard errors, and of all.
Table detection_table(const SceneResults& results);

/// Errors of depth, area and volume.
Table measurement_table(const SceneResults& results);

}  // namespace roadstereo::cli
