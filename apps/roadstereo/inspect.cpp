#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "inspect_flight.hpp"
#include "inspection.hpp"
#include "result_files.hpp"
#include "result_json.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "summary.hpp"

namespace roadstereo::cli {

namespace {

/// The command line of `inspect`.
struct Arguments {
  std::vector<std::string> names;  ///< SOURCE, or LEFT and RIGHT; further words belong to options
  FlightSettings settings;
};

bool is_setting(const std::string& word) {
  return word.find('=') != std::string::npos && word.find(" ! ") == std::string::npos;
}

/// Whether the word is a name of the input: the first one, and RIGHT, or the right one of two recordings.
bool is_input(const std::string& word, const std::vector<std::string>& source) {
  if (source.empty()) return true;
  if (source.size() > 1) return false;
  return !io::is_recording(source[0]) || (io::is_recording(word) && !is_setting(word));
}

/// An option takes one value, so that it never swallows the names of the input. What follows `--set a=1` as `b=2` and
/// `--calibration left.yaml` as `right.yaml` arrives as further names, and is put in its place here.
void place_names(Arguments& arguments) {
  FlightSettings& settings = arguments.settings;
  settings.source.clear();
  for (const std::string& word : arguments.names) {
    if (is_input(word, settings.source)) {
      settings.source.push_back(word);
    } else if (is_setting(word)) {
      settings.processing.settings.push_back(word);
    } else if (settings.calibration.size() == 1) {
      settings.calibration.push_back(word);
    } else {
      fail("unexpected argument \"", word,
           "\": inspect takes SOURCE, or LEFT and RIGHT (see roadstereo inspect --help)");
    }
  }
  if (settings.calibration.size() > 2) fail("--calibration takes one file, or the two of a ROS pair");
}

bool is_one_pair(const FlightSettings& settings) {
  return settings.source.size() == 2 && !io::is_recording(settings.source[0]);
}

/// A pair that shows no road still has a disparity map: damage that cannot be looked for is a warning.
void find_damage(const Pipeline& pipeline, Inspection& inspection) {
  try {
    inspection.damage = pipeline.find_damage();
  } catch (const Error& error) {
    const FrameResult& result = inspection.result;
    inspection.damage = make_empty_damage_map(result.disparity.width(), result.disparity.height(), "no road was found");
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
  if (inspection.pair.calibration && inspection.result.roll_found) {
    inspection.plane = ground_plane(inspection.result.geometry.plane, *inspection.pair.calibration);
  }
}

void refuse_flight_options(const FlightSettings& settings) {
  const auto refuse = [](const char* option) { fail(option, " belongs to a recording; LEFT and RIGHT are one pair"); };
  if (settings.resume) refuse("--resume");
  if (settings.from != 0) refuse("--from");
  if (settings.to) refuse("--to");
  if (settings.every != 1) refuse("--every");
  if (!settings.write.empty()) refuse("--write");
  if (!settings.track.file.empty()) refuse("--track");
}

void inspect_pair(const FlightSettings& settings) {
  refuse_flight_options(settings);
  Inspection inspection;
  inspection.options = make_options(settings.processing);
  inspection.preset = settings.processing.preset;
  inspection.files = {settings.source[0], settings.source[1], settings.calibration};
  inspection.pair = read_pair(inspection.files);
  if (!sets_white_level(settings.processing)) inspection.options.white_level = inspection.pair.white_level;

  io::OutputFolder folder(settings.output);  // before the work, which would be lost on a folder that takes nothing
  process(inspection);
  add_result_files(inspection, folder);
  const std::string result = result_json(inspection);
  folder.add("result.json", result);
  folder.commit();

  if (settings.json) fmt::print("{}", result);
  if (!settings.json && !settings.quiet) fmt::print("{}", summary(inspection, folder.path()));
}

void inspect(Arguments arguments) {
  place_names(arguments);
  is_one_pair(arguments.settings) ? inspect_pair(arguments.settings) : inspect_flight(arguments.settings);
}

constexpr const char* inspect_footer =
    R"(Of one pair the output folder gets disparity.tiff, sigma.tiff (the standard error of disparity.tiff, px) and
transformed.tiff (32-bit float, NaN invalid), disparity.png (16 bit, value / 256 px, 0 invalid), disparity_color.png,
sigma_color.png, transformed_color.png, sheet.png, result.json; damages.json, damages.csv, damage.png (16 bit, ids),
overlay.png and report.html; with a calibration also cloud.ply (camera frame, m) and road_cloud.ply (the road is z = 0).

Of a recording: frames.csv (a row a frame), damages.csv (a row a sighting), summary.json, report.html, a picture of each
damage in damages/, and what --write asks for of every frame; with --track also frames.geojson, damages.geojson and
flight.gpkg. Nothing is dropped; a frame without a result is a row with
its reason. Ctrl-C ends after the frames in flight; --resume goes on there, after a kill, too.

SOURCE is a folder (left/ right/, image_2/ image_3/, image_0/ image_1/, cam0/data cam1/data, or images named L… and R…;
times from times.txt or EuRoC names), a list (.txt or .csv: "left right [seconds]" a line), a video with both views in
one picture, or a ROS 1 bag; or two folders or two videos, left and right.

Calibration formats, recognised by content: plain YAML (focal_px, cx_px, cy_px, baseline_m, width, height),
OpenCV stereo YAML or XML, ROS camera_info (two files, left then right), KITTI calib*.txt, Middlebury
calib.txt, K.txt. A pair whose calibration says that it is not rectified yet is rectified first.
Without a calibration everything metric is absent.

Examples:
  roadstereo inspect left.png right.png --calibration calibration.yaml --output out
  roadstereo inspect left.png right.png --output out --preset paper --set matcher.sigma_space=2
  roadstereo inspect left.png right.png --calibration left.yaml --calibration right.yaml --output out
  roadstereo inspect flight/ --calibration flight/calibration.yaml --output out
  roadstereo inspect zed.mp4 --calibration zed.yaml --every 5 --write sheet --output out

)";

void add_input_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option("SOURCE", arguments.names,
                  "A recording; or LEFT and RIGHT: two images of one size (PNG, JPEG, TIFF, PGM or PPM; 8 or 16 bit)")
      ->required();
  add_calibration_option(command, arguments.settings.calibration);
}

void add_output_options(CLI::App& command, FlightSettings& settings) {
  command.add_option("--output", settings.output, "Folder for the results; made when it is missing")
      ->type_name("DIR")
      ->required();
  command.add_flag("--quiet", settings.quiet, "Print nothing on success");
  command.add_flag("--json", settings.json, "Print result.json (summary.json of a recording) instead of the summary");
}

void add_track_options(CLI::App& command, TrackSettings& track) {
  command
      .add_option("--track", track.file,
                  "GPX, or CSV with time,lat,lon[,alt,heading]: frames and damages get a place on the map")
      ->type_name("FILE");
  command
      .add_option("--track-offset", track.offset_s,
                  "Added to the frames' times to have the track's: when a recording counts from its start, that start "
                  "in seconds since 1970")
      ->type_name("S");
  command.add_option("--mount-yaw", track.mount_yaw_deg, "The camera's forward against the heading, clockwise")
      ->type_name("DEG");
}

void add_flight_options(CLI::App& command, FlightSettings& settings) {
  command.add_flag("--resume", settings.resume, "Go on with the flight that the output folder holds");
  command.add_option("--from", settings.from, "First frame of the recording, from 0")->type_name("N");
  command.add_option("--to", settings.to, "Last frame of the recording, included")->type_name("N");
  command.add_option("--every", settings.every, "Take each N-th frame only")->type_name("N");
  command
      .add_option("--write", settings.write,
                  "What to write of every frame: disparity, transformed, sheet, cloud, overlay, with commas between")
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Disparity, roll, transformed disparity and damage of one stereo pair, or of a whole recording");
  command->footer(inspect_footer + settings_help());
  const auto arguments = std::make_shared<Arguments>();
  add_input_options(*command, *arguments);
  add_output_options(*command, arguments->settings);
  add_flight_options(*command, arguments->settings);
  add_track_options(*command, arguments->settings.track);
  add_source_options(*command, arguments->settings.choice);
  add_processing_options(*command, arguments->settings.processing);
  command->callback([arguments] { inspect(*arguments); });
}

}  // namespace roadstereo::cli
