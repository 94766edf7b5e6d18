#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "inspection.hpp"
#include "result_files.hpp"
#include "result_json.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/options.hpp"
#include "settings.hpp"
#include "summary.hpp"

namespace roadstereo::cli {

namespace {

/// The command line of `inspect`.
struct Arguments {
  PairFiles files;
  std::string output;
  std::string preset = "default";
  std::string engine = "auto";
  int threads = 0;
  std::vector<std::string> settings;
  std::vector<std::string> rest;
  bool quiet = false;
  bool json = false;
};

/// An option takes one value, so that it never swallows LEFT and RIGHT. What follows `--set a=1` as `b=2` and
/// `--calibration left.yaml` as `right.yaml` arrives as further positional arguments, and is put in its place
/// here.
void place_rest(Arguments& arguments) {
  for (const std::string& word : arguments.rest) {
    if (word.find('=') != std::string::npos) {
      arguments.settings.push_back(word);
    } else if (arguments.files.calibration.size() == 1) {
      arguments.files.calibration.push_back(word);
    } else {
      fail("unexpected argument \"", word, "\": inspect takes LEFT and RIGHT (see roadstereo inspect --help)");
    }
  }
  if (arguments.files.calibration.size() > 2) fail("--calibration takes one file, or the two of a ROS pair");
}

PipelineOptions make_options(const Arguments& arguments) {
  PipelineOptions options = preset(arguments.preset);
  options.engine = arguments.engine;
  options.threads = arguments.threads;
  apply_settings(arguments.settings, options);
  options.validate();
  return options;
}

bool sets_white_level(const std::vector<std::string>& settings) {
  return std::any_of(settings.begin(), settings.end(),
                     [](const std::string& setting) { return split_setting(setting).first == "white_level"; });
}

int used_threads(const PipelineOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// A pair that shows no road still has a disparity map: damage that cannot be looked for is a warning.
void find_damage(const Pipeline& pipeline, Inspection& inspection) {
  try {
    inspection.damage = pipeline.find_damage();
  } catch (const Error& error) {
    const FrameResult& result = inspection.result;
    inspection.damage = no_damage(result.disparity.width(), result.disparity.height(), "no road was found");
    inspection.warnings.push_back(std::string("damage was not looked for: ") + error.what());
  }
}

void process(Inspection& inspection) {
  Pipeline pipeline(inspection.options, inspection.pair.calibration);
  inspection.result = pipeline.process(inspection.pair.left.view(), inspection.pair.right.view());
  inspection.engine = pipeline.engine_name();
  inspection.threads = used_threads(inspection.options);
  inspection.warnings = inspection.result.warnings;
  find_damage(pipeline, inspection);
  if (inspection.pair.calibration && inspection.result.geometry_found) {
    inspection.plane = road_plane(inspection.result.geometry.plane, *inspection.pair.calibration);
  }
}

void inspect(Arguments arguments) {
  place_rest(arguments);
  Inspection inspection;
  inspection.options = make_options(arguments);
  inspection.preset = arguments.preset;
  inspection.files = arguments.files;
  inspection.pair = read_pair(arguments.files);
  if (!sets_white_level(arguments.settings)) inspection.options.white_level = inspection.pair.white_level;

  io::OutputFolder folder(arguments.output);  // before the work, which would be lost on a folder that takes nothing
  process(inspection);
  add_result_files(inspection, folder);
  const std::string result = result_json(inspection);
  folder.add("result.json", result);
  folder.commit();

  if (arguments.json) fmt::print("{}", result);
  if (!arguments.json && !arguments.quiet) fmt::print("{}", summary(inspection, folder.path()));
}

std::string joined_presets() {
  std::string names;
  for (const std::string& name : preset_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// Every key of --set with its default and its meaning.
std::string settings_help() {
  std::string text = "Keys of --set, with the values of the default preset:\n";
  for (const OptionText& option : list_options(preset("default"))) {
    text += fmt::format("  {:<38} {:<12} {}\n", option.key, option.value, option.description);
  }
  return text;
}

constexpr const char* inspect_footer =
    R"(Into the output folder: disparity.tiff, sigma.tiff (the standard error of disparity.tiff, px) and transformed.tiff
(32-bit float, NaN invalid), disparity.png (16 bit, value / 256 px, 0 invalid), disparity_color.png, sigma_color.png,
transformed_color.png, sheet.png, result.json; damages.json, damages.csv, damage.png (16 bit, ids), overlay.png and
report.html; with a calibration also cloud.ply (camera frame, m) and road_cloud.ply (the road is z = 0).

Calibration formats, recognised by content: plain YAML (focal_px, cx_px, cy_px, baseline_m, width, height),
OpenCV stereo YAML or XML, ROS camera_info (two files, left then right), KITTI calib*.txt, Middlebury
calib.txt, K.txt. A pair whose calibration says that it is not rectified yet is rectified first.
Without a calibration everything metric is absent.

Examples:
  roadstereo inspect left.png right.png --calibration calibration.yaml --output out
  roadstereo inspect left.png right.png --output out --preset paper --set matcher.sigma_space=2
  roadstereo inspect left.png right.png --calibration left.yaml --calibration right.yaml --output out

)";

void add_input_options(CLI::App& command, Arguments& arguments) {
  command.add_option("LEFT", arguments.files.left, "Left image: PNG, JPEG, TIFF, PGM or PPM; 8 or 16 bit")->required();
  command.add_option("RIGHT", arguments.files.right, "Right image, of the same size")->required();
  command.add_option("REST", arguments.rest)->group("");
  command
      .add_option("--calibration", arguments.files.calibration,
                  "Calibration of the rig; give it twice (left, right) for a ROS pair")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

void add_treatment_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--preset", arguments.preset, "Where the options start from: " + joined_presets())
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--engine", arguments.engine, "Matching engine, see roadstereo engines")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--threads", arguments.threads, "Worker threads; 0 takes all cores")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--set", arguments.settings, "Sets one option; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

void add_output_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--output", arguments.output, "Folder for the results; made when it is missing")
      ->type_name("DIR")
      ->required();
  command.add_flag("--quiet", arguments.quiet, "Print nothing on success");
  command.add_flag("--json", arguments.json, "Print result.json instead of the summary");
}

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("inspect", "Disparity, roll, transformed disparity and damage of one stereo pair");
  command->footer(inspect_footer + settings_help());
  const auto arguments = std::make_shared<Arguments>();
  add_input_options(*command, *arguments);
  add_output_options(*command, *arguments);
  add_treatment_options(*command, *arguments);
  command->callback([arguments] { inspect(*arguments); });
}

}  // namespace roadstereo::cli
