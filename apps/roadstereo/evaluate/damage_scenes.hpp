#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/damage_method.hpp"
#include "evaluate/damage_regions.hpp"
#include "evaluate/table.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// One damage of a synthetic road and the region found on it.
struct SceneDamage {
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
  std::string method;
  std::vector<SceneDamage> damages;
  std::size_t found = 0;            ///< regions
  std::size_t false_positives = 0;  ///< regions of which less than a third is damage
  std::vector<FoundRegion> regions;
  int scenes = 0;
};

/// Random scenes, by seed, or the scenes of a folder.
struct SceneSet {
  int scenes = 60;
  std::uint64_t first_seed = 1000;
  bool degraded = false;  ///< noise, blur, exposure
  bool wide = false;      ///< synth::random_wide_scene
  bool ruts = false;      ///< rutted_scene
  std::string folder;     ///< with folders of one scene each (`scene_folders`); empty: random scenes
};

/// Score the damage that every method finds in the scenes. The frame of given maps is the seed in six digits, or the
/// name of the folder.
std::vector<SceneResults> score_scenes(const SceneSet& set, const std::vector<DamageMethod>& methods);

/// Write the pairs of random scenes, named by their seeds.
void write_scene_pairs(const SceneSet& set, const std::string& folder);

/// Table of recall by kind: of all damages, and of those deeper than three standard errors.
Table detection_table(const std::vector<SceneResults>& results);

/// Table of the errors of depth, area and volume.
Table measurement_table(const std::vector<SceneResults>& results);

}  // namespace roadstereo::cli
