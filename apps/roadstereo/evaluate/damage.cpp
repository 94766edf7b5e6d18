#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "evaluate/damage_labels.hpp"
#include "evaluate/damage_roads.hpp"
#include "evaluate/damage_scenes.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;

struct DamageArguments {
  std::string data;
  std::string preset = "default";
  int scenes = 60;
  std::uint64_t first_seed = 1000;
  bool degraded = false;
  std::string json;
};

constexpr const char* label_note =
    "labels: connected components of the label; found: those that depressions cover by at least a third; false\n"
    "positives: depressions of which less than a third is labelled; measured: labelled pixels with a disparity.\n";

constexpr const char* road_note =
    "IoU, precision and recall over the pixels with a true disparity. The road is intact, so that all damage is "
    "false.\n";

constexpr const char* scene_note =
    "found: a region covers at least a third of the damage. Standard error: noise of the road, standard error of the\n"
    "disparity and sub-pixel bias combined, for damage of at least 64 pixels. precise: at least 20 mm deep, standard "
    "error\n"
    "of the maximum depth at most 2 mm.\n";

void print_and_write(const DamageArguments& arguments, const Table& table, const char* note) {
  fmt::print("{}\n{}", table.text(), note);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "damage"}, {"preset", arguments.preset}, {"rows", table.json()}});
}

void score_synthetic(const DamageArguments& arguments) {
  const SceneResults results =
      score_scenes(arguments.scenes, arguments.first_seed, arguments.degraded, arguments.preset);
  const Table detection = detection_table(results);
  const Table measurement = measurement_table(results);
  fmt::print("{}\n{} regions on {} roads, {} false positives\n\n{}\n{}", detection.text(), results.found,
             results.scenes, results.false_positives, measurement.text(), scene_note);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "damage"},
                                {"preset", arguments.preset},
                                {"scenes", results.scenes},
                                {"regions", results.found},
                                {"false_positives", results.false_positives},
                                {"detection", detection.json()},
                                {"measurement", measurement.json()}});
}

void run(const DamageArguments& arguments) {
  preset(arguments.preset);  // throws now if there is no such preset
  const fs::path root = arguments.data;
  if (arguments.data.empty()) {
    score_synthetic(arguments);
  } else if (fs::is_directory(root / "disp_tg")) {
    print_and_write(arguments, label_table(score_labelled_maps(arguments.data)), label_note);
  } else if (fs::is_directory(root / "label")) {
    print_and_write(arguments, label_table(score_labelled_pairs(arguments.data, arguments.preset)), label_note);
  } else if (fs::is_directory(root / "image_2")) {
    print_and_write(arguments, road_table(score_intact_roads(arguments.data, arguments.preset)), road_note);
  } else {
    fail(arguments.data,
         ": the folder must contain disp_tg (maps with labels), label (pairs with labels) or image_2 (KITTI)");
  }
}

}  // namespace

void add_damage_accuracy(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("damage", "Detection and measurement of damage against labels or exact ground truth");
  const auto arguments = std::make_shared<DamageArguments>();
  command->add_option(
      "DIR", arguments->data,
      "Folder with disp_tg and label, with left, right and label, or of KITTI; if absent, synthetic roads");
  command->add_option("--preset", arguments->preset, "Preset for matching")->type_name("NAME")->capture_default_str();
  command->add_option("--scenes", arguments->scenes, "Number of synthetic roads")
      ->type_name("N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--seed", arguments->first_seed, "Seed of the first road")->type_name("N")->capture_default_str();
  command->add_flag("--degraded", arguments->degraded, "Degrade the synthetic images: noise, blur, exposure");
  command->add_option("--json", arguments->json, "Also write the results to this file")->type_name("FILE");
  command->footer(
      "Examples:\n  roadstereo evaluate damage potholes\n  roadstereo evaluate damage --scenes 20 --json damage.json");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
