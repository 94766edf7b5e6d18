#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "evaluate/damage_labels.hpp"
#include "evaluate/damage_roads.hpp"
#include "evaluate/damage_scenes.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/pair_files.hpp"
#include "evaluate/report.hpp"
#include "evaluate/scene_folders.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

struct DamageArguments {
  std::string data;
  std::string preset = "default";
  SceneSet set;
  std::vector<GivenMaps> maps;
  std::string pairs_folder;  ///< of --write-pairs
  std::string json;
};

constexpr const char* label_note =
    "labels: connected components of the label of 50 pixels or more; found: those that depressions cover by at least\n"
    "a third; false positives: depressions of which less than a third is labelled; measured: labelled pixels with a\n"
    "disparity.\n";

constexpr const char* road_note =
    "IoU, precision and recall over the pixels with a true disparity. The road is intact, so that all damage is "
    "false.\n";

constexpr const char* scene_note =
    "found: a region covers at least a third of the damage. Standard error: noise of the road, standard error of the\n"
    "disparity and sub-pixel bias combined, for damage of at least 64 pixels. precise: at least 20 mm deep, standard "
    "error\n"
    "of the maximum depth at most 2 mm.\n";

constexpr const char* confidence_note = "damage: at least a third of the region is labelled.\n";

template <class Results>
void print_and_write(const DamageArguments& arguments, const Results& results, const Table& table, const char* note) {
  std::vector<FoundRegion> regions;
  for (const auto& one : results) {
    if (one.method == results.front().method) regions.insert(regions.end(), one.regions.begin(), one.regions.end());
  }
  const Table confidence = confidence_table(regions);
  fmt::print("{}\n{}\n{}{}", table.text(), note, confidence.text(), confidence_note);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "damage"},
                                {"preset", results.front().method},
                                {"rows", table.json()},
                                {"confidence", confidence.json()},
                                {"found_regions", regions_json(regions)}});
}

void score_synthetic(const DamageArguments& arguments, const std::vector<DamageMethod>& methods) {
  const std::vector<SceneResults> results = score_scenes(arguments.set, methods);
  const Table detection = detection_table(results);
  const Table measurement = measurement_table(results);
  fmt::print("{}\n", detection.text());
  nlohmann::ordered_json others;
  for (const SceneResults& one : results) {
    fmt::print("{}: {} regions on {} roads, {} false positives\n", one.method, one.found, one.scenes,
               one.false_positives);
    if (one.method == arguments.preset) continue;
    others[one.method] = {{"regions", one.found}, {"false_positives", one.false_positives}};
  }
  const Table confidence = confidence_table(results.front().regions);
  fmt::print("\n{}\n{}\n{}{}", measurement.text(), scene_note, confidence.text(), confidence_note);
  if (arguments.json.empty()) return;
  nlohmann::ordered_json document{{"experiment", "damage"},
                                  {"preset", arguments.preset},
                                  {"scenes", results.front().scenes},
                                  {"regions", results.front().found},
                                  {"false_positives", results.front().false_positives},
                                  {"detection", detection.json()},
                                  {"measurement", measurement.json()},
                                  {"confidence", confidence.json()},
                                  {"found_regions", regions_json(results.front().regions)}};
  if (!others.empty()) document["maps"] = others;
  write_report(arguments.json, document);
}

void run(DamageArguments arguments) {
  preset(arguments.preset);  // throws now if there is no such preset
  const fs::path root = arguments.data;
  const std::vector<DamageMethod> methods = damage_methods(arguments.preset, arguments.maps);
  if (!arguments.pairs_folder.empty()) {
    write_scene_pairs(arguments.set, arguments.pairs_folder);
  } else if (arguments.data.empty()) {
    score_synthetic(arguments, methods);
  } else if (!fs::is_directory(root)) {
    fail(arguments.data, " is not a folder");
  } else if (fs::is_directory(root / "disp_tg")) {
    if (!arguments.maps.empty()) fail("--maps is for pairs; it must not be given with transformed maps (disp_tg)");
    const std::vector<LabelResult> results = score_labelled_maps(arguments.data);
    print_and_write(arguments, results, label_table(results), label_note);
  } else if (fs::is_directory(root / "label")) {
    const std::vector<LabelResult> results = score_labelled_pairs(arguments.data, methods);
    print_and_write(arguments, results, label_table(results), label_note);
  } else if (fs::is_directory(root / "image_2")) {
    const std::vector<RoadResult> results = score_intact_roads(arguments.data, methods);
    print_and_write(arguments, results, road_table(results), road_note);
  } else if (!scene_folders(root).empty()) {
    arguments.set.folder = arguments.data;
    score_synthetic(arguments, methods);
  } else {
    fail(arguments.data,
         ": the folder must contain disp_tg (maps with labels), label (pairs with labels), image_2 (KITTI) or folders "
         "of "
         "synthetic scenes");
  }
}

}  // namespace

void add_damage_accuracy(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("damage", "Detection and measurement of damage against labels or exact ground truth");
  const auto arguments = std::make_shared<DamageArguments>();
  CLI::Option* folder = command->add_option(
      "DIR", arguments->data,
      "Folder with disp_tg and label, with left, right and label, of KITTI, or with synthetic scenes; if absent, roads "
      "are rendered");
  command->add_option("--preset", arguments->preset, "Preset for matching")->type_name("NAME")->capture_default_str();
  command->add_option("--scenes", arguments->set.scenes, "Number of synthetic roads")
      ->type_name("N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--seed", arguments->set.first_seed, "Seed of the first road")
      ->type_name("N")
      ->capture_default_str();
  CLI::Option* degraded =
      command->add_flag("--degraded", arguments->set.degraded, "Degrade the synthetic images: noise, blur, exposure");
  command->add_flag("--wide", arguments->set.wide, "Render scenes of the widest kind, as synth --scene random does")
      ->excludes(degraded);
  command->add_flag("--ruts", arguments->set.ruts, "Render roads with ruts, degraded")
      ->excludes(degraded)
      ->excludes("--wide");
  add_maps_option(*command, arguments->maps);
  add_json_option(*command, arguments->json);
  add_write_pairs_option(*command, arguments->pairs_folder)->excludes("--preset")->excludes(folder);
  for (const char* rendered : {"--scenes", "--seed", "--degraded", "--wide", "--ruts"}) folder->excludes(rendered);
  command->footer(
      "Examples:\n  roadstereo evaluate damage potholes\n  roadstereo evaluate damage --scenes 20 --json damage.json\n"
      "  roadstereo evaluate damage --scenes 20 --write-pairs pairs    # match them, then\n"
      "  roadstereo evaluate damage --scenes 20 --maps mine=my_maps");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
