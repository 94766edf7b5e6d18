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

struct Arguments {
  std::string data;
  std::string preset = "default";
  int scenes = 60;
  std::uint64_t first_seed = 1000;
  bool degraded = false;
  std::string json;
};

constexpr const char* label_note =
    "A label is found when depressions cover a third of it; a depression is invented when less than a third of it is\n"
    "labelled. measured: labelled pixels that have a disparity.\n";

constexpr const char* road_note =
    "IoU over the pixels that have a true disparity. The road is intact: every damage on it is false.\n";

constexpr const char* scene_note =
    "Found: a region covers a third of it. Standard error: noise of the road, of the disparity and of the sub-pixel "
    "step\n"
    "together; counted from 64 pixels on. Precise ones: at least 20 mm deep, largest depth known to 2 mm.\n";

void finish(const Arguments& arguments, const Table& table, const char* note) {
  fmt::print("{}\n{}", table.text(), note);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "damage"}, {"preset", arguments.preset}, {"rows", table.json()}});
}

void score_synthetic(const Arguments& arguments) {
  const SceneResults results =
      score_scenes(arguments.scenes, arguments.first_seed, arguments.degraded, arguments.preset);
  const Table detection = detection_table(results);
  const Table measurement = measurement_table(results);
  fmt::print("{}\n{} regions on {} roads, {} invented\n\n{}\n{}", detection.text(), results.found, results.scenes,
             results.invented, measurement.text(), scene_note);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "damage"},
                                {"preset", arguments.preset},
                                {"scenes", results.scenes},
                                {"regions", results.found},
                                {"invented", results.invented},
                                {"detection", detection.json()},
                                {"measurement", measurement.json()}});
}

void run(const Arguments& arguments) {
  preset(arguments.preset);  // one that does not exist is refused by its name, before any work
  const fs::path root = arguments.data;
  if (arguments.data.empty()) {
    score_synthetic(arguments);
  } else if (fs::is_directory(root / "disp_tg")) {
    finish(arguments, label_table(score_labelled_maps(arguments.data)), label_note);
  } else if (fs::is_directory(root / "label")) {
    finish(arguments, label_table(score_labelled_pairs(arguments.data, arguments.preset)), label_note);
  } else if (fs::is_directory(root / "image_2")) {
    finish(arguments, road_table(score_intact_roads(arguments.data, arguments.preset)), road_note);
  } else {
    fail(arguments.data, " has neither disp_tg (maps with labels), nor label (pairs with labels), nor image_2 (KITTI)");
  }
}

}  // namespace

void add_damage_accuracy(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("damage", "Damage found and measured, against labels or exact truth");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("DIR", arguments->data,
                      "Folder with disp_tg and label, with left, right and label, or of KITTI; none: synthetic roads");
  command->add_option("--preset", arguments->preset, "Preset that matches the pairs")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--scenes", arguments->scenes, "Number of synthetic roads")
      ->type_name("N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--seed", arguments->first_seed, "Seed of the first road")->type_name("N")->capture_default_str();
  command->add_flag("--degraded", arguments->degraded, "Wear the synthetic pictures: noise, blur, exposure");
  command->add_option("--json", arguments->json, "Write the same figures to this file")->type_name("FILE");
  command->footer(
      "Examples:\n  roadstereo evaluate damage potholes\n  roadstereo evaluate damage --scenes 20 --json damage.json");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
