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

constexpr std::size_t min_pixels = 64;

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

bool is_resolvable(const SceneDamage& damage) {
  constexpr double min_std_errors = 3;
  return damage.pixels >= min_pixels && damage.depth_px > min_std_errors * damage.std_error_px;
}

bool is_comparable(const SceneDamage& damage) {
  return damage.found && damage.found->metrics && damage.fully_visible && damage.is_single &&
         !damage.found->cut_by_border && damage.truth.kind != "crack";
}

/// A rut is as deep in the picture as beyond it.
bool is_comparable_rut(const SceneDamage& damage) {
  return damage.found && damage.found->metrics && damage.is_single && damage.truth.kind == "rut";
}

/// Quantity of a damage, measured and true.
struct Quantity {
  const char* name;
  bool (*is_comparable)(const SceneDamage&);
  Measurement (*measured)(const DamageMetrics&);
  double (*truth)(const synth::DamageTruth&);
};

constexpr Quantity quantities[] = {
    {"maximum depth", is_comparable, [](const DamageMetrics& m) { return m.max_depth_m; },
     [](const synth::DamageTruth& t) { return t.depth_m; }},
    {"mean depth", is_comparable, [](const DamageMetrics& m) { return m.mean_depth_m; },
     [](const synth::DamageTruth& t) { return t.mean_depth_m; }},
    {"area", is_comparable, [](const DamageMetrics& m) { return m.area_m2; },
     [](const synth::DamageTruth& t) { return t.area_m2; }},
    {"volume", is_comparable, [](const DamageMetrics& m) { return m.volume_m3; },
     [](const synth::DamageTruth& t) { return t.volume_m3; }},
    {"depth of ruts", is_comparable_rut, [](const DamageMetrics& m) { return m.max_depth_m; },
     [](const synth::DamageTruth& t) { return t.depth_m; }},
};

std::vector<Cell> quantity_row(const Quantity& quantity, const SceneResults& results) {
  constexpr double min_depth_m = 0.020;
  constexpr double max_error_m = 0.002;
  constexpr double percent = 100;
  double count = 0;
  double within = 0;
  std::vector<double> errors;
  double precise = 0;
  double precise_errors = 0;
  for (const SceneDamage& damage : results.damages) {
    if (!quantity.is_comparable(damage)) continue;
    const DamageMetrics& metrics = *damage.found->metrics;
    const Measurement measured = quantity.measured(metrics);
    const double truth = quantity.truth(damage.truth);
    const double relative = measured.value / truth - 1;
    ++count;
    within += std::abs(measured.value - truth) <= 2 * measured.std_error ? 1 : 0;
    errors.push_back(relative);
    if (damage.truth.depth_m < min_depth_m || metrics.max_depth_m.std_error > max_error_m) continue;
    ++precise;
    precise_errors += std::abs(relative);
  }
  return {Cell(results.method),
          Cell(quantity.name),
          Cell(count, 0),
          Cell(percent * within / count, 1),
          Cell(percent * median(errors), 1),
          Cell(precise, 0),
          Cell(percent * precise_errors / precise, 1)};
}

void add_detection_rows(const SceneResults& results, Table& table) {
  double all = 0;
  double all_found = 0;
  for (const char* kind : scene_kinds) {
    double in_view = 0;
    double found = 0;
    double deep = 0;
    double deep_found = 0;
    for (const SceneDamage& damage : results.damages) {
      if (damage.truth.kind != kind) continue;
      ++in_view;
      found += damage.found ? 1 : 0;
      if (!is_resolvable(damage)) continue;
      ++deep;
      deep_found += damage.found ? 1 : 0;
    }
    if (in_view == 0) continue;
    table.rows.push_back({Cell(results.method), Cell(kind), Cell(in_view, 0), Cell(found, 0), Cell(deep, 0),
                          Cell(deep_found, 0), Cell(deep > 0 ? deep_found / deep : std::nan(""), 3)});
    if (std::string(kind) == "crack") continue;
    all += deep;
    all_found += deep_found;
  }
  table.rows.push_back({Cell(results.method), Cell("without cracks"), Cell(std::nan(""), 0), Cell(std::nan(""), 0),
                        Cell(all, 0), Cell(all_found, 0), Cell(all_found / all, 3)});
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

Table detection_table(const std::vector<SceneResults>& results) {
  Table table{"Damage found",
              {{"method", "method"},
               {"kind", "kind"},
               {"in view", "in_view"},
               {"found", "found"},
               {"> 3 std. errors", "deeper_than_3_std_errors"},
               {"found", "found_of_those"},
               {"recall", "recall"}},
              {}};
  for (const SceneResults& of_method : results) add_detection_rows(of_method, table);
  return table;
}

Table measurement_table(const std::vector<SceneResults>& results) {
  Table table{"Measured against the truth: found potholes and bumps that are fully visible and do not merge",
              {{"method", "method"},
               {"quantity", "quantity"},
               {"count", "count"},
               {"within 2 std. errors %", "within_2_std_errors_percent"},
               {"median error %", "median_error_percent"},
               {"precise", "precise"},
               {"mean |error| %", "mean_abs_error_percent"}},
              {}};
  for (const SceneResults& of_method : results) {
    for (const Quantity& quantity : quantities) {
      const auto& damages = of_method.damages;
      if (std::any_of(damages.begin(), damages.end(), quantity.is_comparable)) {
        table.rows.push_back(quantity_row(quantity, of_method));
      }
    }
  }
  return table;
}

}  // namespace roadstereo::cli
