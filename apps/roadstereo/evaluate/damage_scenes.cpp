#include "evaluate/damage_scenes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "evaluate/pair_files.hpp"
#include "evaluate/rendered_pair.hpp"
#include "evaluate/rutted_scenes.hpp"
#include "evaluate/scene_folders.hpp"
#include "finite_values.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/resolution_limits.hpp"

namespace roadstereo::cli {
namespace {

/// Pixels of one damage of the ground truth.
struct Cover {
  std::size_t pixels = 0;
  bool fully_visible = true;
  double disparity = 0;  ///< sum
  std::vector<double> sigmas;
  std::map<std::uint16_t, std::size_t> found;  ///< pixels by the id found there
};

struct SceneCase {
  const synth::SyntheticPair& pair;
  const FrameResult& frame;
  const DamageMap& map;
};

/// Whether something nearer than the road, or without a true disparity, hides what is beside the pixel.
bool is_beside_occluder(const Image<double>& disparity, int u, int v) {
  constexpr double min_step_px = 1;
  const auto hides = [&](int x, int y) { return !(disparity(x, y) < disparity(u, v) + min_step_px); };
  return hides(u - 1, v) || hides(u + 1, v) || hides(u, v - 1) || hides(u, v + 1);
}

std::map<int, Cover> covers_of(const SceneCase& scene) {
  std::map<int, Cover> covers;
  const auto& labels = scene.pair.labels;
  for (int v = 0; v < labels.height(); ++v) {
    for (int u = 0; u < labels.width(); ++u) {
      if (labels(u, v) == 0) continue;
      Cover& cover = covers[labels(u, v)];
      ++cover.pixels;
      cover.disparity += scene.pair.disparity(u, v);
      if (u == 0 || v == 0 || u + 1 == labels.width() || v + 1 == labels.height() ||
          is_beside_occluder(scene.pair.disparity, u, v)) {
        cover.fully_visible = false;
      }
      if (!scene.frame.sigma.empty() && !std::isnan(scene.frame.sigma(u, v)))
        cover.sigmas.push_back(scene.frame.sigma(u, v));
      if (scene.map.ids(u, v) != 0) ++cover.found[scene.map.ids(u, v)];
    }
  }
  return covers;
}

/// Id of the region that covers most of the damage, at least a third; 0 if there is none.
std::uint16_t best_match(const Cover& cover) {
  std::uint16_t best = 0;
  std::size_t max_pixels = 0;
  for (const auto& [id, pixels] : cover.found) {
    if (pixels > max_pixels) {
      max_pixels = pixels;
      best = id;
    }
  }
  return static_cast<double>(max_pixels) >= min_damage_share * static_cast<double>(cover.pixels) ? best : 0;
}

SceneDamage describe(const SceneCase& scene, const synth::DamageTruth& truth, const Cover& cover, double height_m) {
  SceneDamage damage;
  damage.truth = truth;
  damage.pixels = cover.pixels;
  damage.fully_visible = cover.fully_visible;
  damage.depth_px = truth.depth_m * cover.disparity / static_cast<double>(cover.pixels) / height_m;
  const double noise_px = scene.map.has_road() ? scene.map.noise_px : 0;  // damage of a road not found counts as missed
  damage.std_error_px = std::hypot(noise_px, cover.sigmas.empty() ? noise_px : median(cover.sigmas), sub_pixel_bias_px);
  const std::uint16_t id = best_match(cover);
  if (id == 0) return damage;
  damage.found = scene.map.damages[id - 1U];
  const auto own = static_cast<double>(cover.found.at(id));
  constexpr double min_own_share = 0.8;  // of the part of the region that lies on any damage
  std::size_t on_damage = 0;
  for (int v = 0; v < scene.map.ids.height(); ++v) {
    for (int u = 0; u < scene.map.ids.width(); ++u) {
      on_damage += scene.map.ids(u, v) == id && scene.pair.labels(u, v) != 0 ? 1U : 0U;
    }
  }
  damage.is_single = own >= min_own_share * static_cast<double>(on_damage);
  return damage;
}

std::size_t count_false_positives(const SceneCase& scene) {
  std::vector<std::size_t> true_pixels(scene.map.damages.size(), 0);
  for (int v = 0; v < scene.map.ids.height(); ++v) {
    for (int u = 0; u < scene.map.ids.width(); ++u) {
      const std::uint16_t id = scene.map.ids(u, v);
      if (id != 0 && scene.pair.labels(u, v) != 0) ++true_pixels[id - 1U];
    }
  }
  std::size_t count = 0;
  for (std::size_t k = 0; k < true_pixels.size(); ++k) {
    const auto pixels = static_cast<double>(scene.map.damages[k].pixels);
    count += static_cast<double>(true_pixels[k]) < min_damage_share * pixels ? 1U : 0U;
  }
  return count;
}

/// A scene with its truth and the name of its files.
struct LabelledScene {
  std::string frame;
  synth::SyntheticPair pair;
  double camera_height_m = 0;
};

LabelledScene render_scene(const SceneSet& set, int index) {
  const std::uint64_t seed = set.first_seed + static_cast<std::uint64_t>(index);
  const synth::Scene scene = set.wide   ? synth::random_wide_scene(seed)
                             : set.ruts ? rutted_scene(seed)
                                        : synth::random_scene(seed, set.degraded);
  return {fmt::format("{:06}", seed), render_recorded(scene), scene.rig.camera_height_m};
}

LabelledScene read_scene(const std::filesystem::path& folder) {
  LabelledFrame files = read_scene_folder(folder);
  if (!files.pair.calibration) fail(folder.string(), ": calibration.yaml is missing");
  LabelledScene scene;
  scene.frame = folder.filename().string();
  scene.pair.left = std::move(files.pair.left);
  scene.pair.right = std::move(files.pair.right);
  scene.pair.calibration = *files.pair.calibration;
  scene.pair.disparity.resize(files.truth.width(), files.truth.height());
  std::copy_n(files.truth.row(0), files.truth.pixels(), scene.pair.disparity.row(0));
  SceneTruth truth = read_scene_truth(folder, files.truth);
  scene.pair.labels = std::move(truth.labels);
  scene.pair.damages = std::move(truth.damages);
  scene.camera_height_m = truth.camera_height_m;
  return scene;
}

void add_scene(const LabelledScene& scene, const DamageMethod& method, SceneResults& results) {
  const FrameDamage found = find_damage_of(method, pair_of(scene.pair), scene.frame);
  const SceneCase scene_case{scene.pair, found.frame, found.map};
  const std::map<int, Cover> covers = covers_of(scene_case);
  for (const synth::DamageTruth& truth : scene.pair.damages) {
    const auto cover = covers.find(truth.id);
    if (cover == covers.end()) continue;  // out of view
    results.damages.push_back(describe(scene_case, truth, cover->second, scene.camera_height_m));
  }
  results.found += found.map.damages.size();
  results.false_positives += count_false_positives(scene_case);
  const std::vector<FoundRegion> regions =
      found_regions(scene.frame, found.map, [&](int u, int v) { return scene.pair.labels(u, v) != 0; });
  results.regions.insert(results.regions.end(), regions.begin(), regions.end());
}

}  // namespace

std::vector<SceneResults> score_scenes(const SceneSet& set, const std::vector<DamageMethod>& methods) {
  const std::vector<std::filesystem::path> folders =
      set.folder.empty() ? std::vector<std::filesystem::path>{} : scene_folders(set.folder);
  const int scenes = set.folder.empty() ? set.scenes : static_cast<int>(folders.size());
  std::vector<SceneResults> all(methods.size());
  for (std::size_t i = 0; i < methods.size(); ++i) {
    all[i].method = methods[i].name;
    all[i].scenes = scenes;
  }
  Progress progress = Progress::on_terminal(static_cast<std::size_t>(scenes));
  for (int k = 0; k < scenes; ++k) {
    const LabelledScene scene =
        set.folder.empty() ? render_scene(set, k) : read_scene(folders[static_cast<std::size_t>(k)]);
    for (std::size_t i = 0; i < methods.size(); ++i) add_scene(scene, methods[i], all[i]);
    progress.frame_done();
  }
  return all;
}

void write_scene_pairs(const SceneSet& set, const std::string& folder) {
  io::OutputFolder files(folder);
  for (int k = 0; k < set.scenes; ++k) {
    const LabelledScene rendered = render_scene(set, k);
    add_pair(rendered.frame, pair_of(rendered.pair), files);
  }
  files.commit();
}

}  // namespace roadstereo::cli
