#include "roadstereo/damage.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "map_source.hpp"
#include "output_owner.hpp"
#include "processing_options.hpp"
#include "report_head.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_files.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/io/severity_file.hpp"
#include "roadstereo/options.hpp"
#include "settings.hpp"
#include "summary.hpp"

namespace roadstereo::cli {
namespace {

struct DamageArguments {
  MapFiles files;
  std::string output;
  std::vector<std::string> settings;
  std::string severity = "d6433";
  ReportHead head;
  int threads = 0;
  bool quiet = false;
};

/// Throws Error for options of other stages.
DamageOptions make_options(const std::vector<std::string>& settings, const std::string& severity) {
  PipelineOptions options;
  for (const std::string& setting : settings) {
    const std::string key = split_setting(setting).first;
    if (key.rfind("damage.", 0) != 0)
      fail("\"", key, "\" has no effect here; damage accepts keys that start with damage.");
  }
  apply_settings(settings, options);
  options.damage.severity = io::read_severity_scheme(severity);
  options.damage.validate();
  return options.damage;
}

DamageMap find_in(const TransformedMap& map, double white_level, const DamageArguments& arguments) {
  GreyImage grey;
  if (map.image) to_grey(map.image->view(), white_level, grey);
  DamageInput input;
  input.transformed = map.transformed;
  input.grey = grey;
  if (map.disparity) input.disparity = *map.disparity;
  input.plane = map.plane;
  input.calibration = map.calibration;
  try {
    return find_damage(input, make_options(arguments.settings, arguments.severity), arguments.threads);
  } catch (const Error& error) {
    fail(arguments.files.transformed, ": ", error.what());
  }
}

void run(const DamageArguments& arguments) {
  make_options(arguments.settings, arguments.severity);  // checked first
  const TransformedMap map = read_transformed_map(arguments.files, arguments.threads);
  require_no_other_owner(arguments.output, OutputOwner::none);
  io::OutputFolder folder(arguments.output);
  const MapFiles& files = arguments.files;
  for (const auto& inputs : {std::vector{files.transformed, files.image, files.disparity}, files.calibration}) {
    for (const std::string& input : inputs) folder.protect(input);
  }
  const double white_level = map.image ? io::find_white_level(map.image->view(), map.image->view()) : 0;
  const DamageMap damage = find_in(map, white_level, arguments);
  io::DamageReportInput report{damage};
  if (map.image) report.left = map.image->view();
  report.white_level = white_level;
  if (map.disparity) report.disparity = *map.disparity;
  report.transformed = map.transformed;
  report.calibration = map.calibration;
  report.title = title_of(arguments.head, std::filesystem::path(arguments.files.transformed).filename().string());
  report.head = head_lines(arguments.head);
  report.severity = make_options(arguments.settings, arguments.severity).severity;
  report.properties = {{"Transformed map", fmt::format("{}×{} px", map.transformed.width(), map.transformed.height())}};
  io::add_damage_files(folder, report);
  folder.commit();
  if (arguments.quiet) return;
  fmt::print("{}: {}\n", arguments.files.transformed, damage_text(damage, {}));
  if (!damage.metric) fmt::print("  no metric values: {}\n", damage.non_metric_reason);
  fmt::print("  report    {}\n  overlay   {}\n", (folder.path() / "report.html").string(),
             (folder.path() / "overlay.png").string());
}

constexpr const char* damage_footer =
    R"(Writes damages.json, damages.csv, damage.png (16 bit, ids), overlay.png and report.html to the output folder.

Depressions have smaller values than the road. Without --disparity and --calibration the unit is that of the map.

Examples:
  roadstereo damage transformed.tiff --image left.png --output out
  roadstereo damage transformed.png --disparity disparity.tiff --calibration calibration.yaml --output out)";

}  // namespace

void add_damage(CLI::App& app) {
  CLI::App* command = app.add_subcommand("damage", "Find and measure damage in a transformed disparity map");
  command->footer(damage_footer);
  const auto arguments = std::make_shared<DamageArguments>();
  command
      ->add_option("TRANSFORMED", arguments->files.transformed,
                   "Transformed disparity: float TIFF, PFM, or 16-bit PNG of any scale (0 invalid)")
      ->required();
  command->add_option("--image", arguments->files.image, "Left image, background of the outlines")->type_name("FILE");
  command->add_option("--disparity", arguments->files.disparity, "Disparity map of the same view")->type_name("FILE");
  command
      ->add_option("--calibration", arguments->files.calibration,
                   "Calibration file; with --disparity the values are metric")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--output", arguments->output, "Output folder; created if missing")->type_name("DIR")->required();
  command->add_option("--set", arguments->settings, "Set one option, see roadstereo options damage; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  add_severity_option(*command, arguments->severity);
  add_head_options(*command, arguments->head);
  command->add_option("--threads", arguments->threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "Print nothing on success");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
