#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "core/parallel.hpp"
#include "find_damage_or_warn.hpp"
#include "given_disparity.hpp"
#include "inspect_flight.hpp"
#include "inspection.hpp"
#include "output_owner.hpp"
#include "result_files.hpp"
#include "result_json.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "stop_signals.hpp"
#include "summary.hpp"

namespace roadstereo::cli {

namespace {

/// Command line of `inspect`.
struct InspectArguments {
  std::vector<std::string> names;  ///< SOURCE, or LEFT and RIGHT; further words are values of options
  FlightSettings settings;
};

bool is_setting(const std::string& word) {
  return word.find('=') != std::string::npos && word.find(" ! ") == std::string::npos;
}

/// Whether the word names an input: the first word, RIGHT, or the second of two recordings.
bool is_input(const std::string& word, const std::vector<std::string>& source) {
  if (source.empty()) return true;
  if (source.size() > 1) return false;
  return !io::is_recording(source[0]) || (io::is_recording(word) && !is_setting(word));
}

/// Assigns further words to their options. An option takes one value only, so that it does not consume the names of the
/// input: `b=2` after `--set a=1` and `right.yaml` after `--calibration left.yaml` are parsed as names.
void assign_names(InspectArguments& arguments) {
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
           "\": inspect needs SOURCE, or LEFT and RIGHT (see roadstereo inspect --help)");
    }
  }
  if (settings.calibration.size() > 2) fail("--calibration needs one file, or two: left and right");
}

bool is_one_pair(const FlightSettings& settings) {
  if (!settings.disparity.empty() && io::is_recording(settings.source[0])) {
    fail("--disparity is for one pair, LEFT and optionally RIGHT; ", settings.source[0], " is a recording");
  }
  return !settings.disparity.empty() || (settings.source.size() == 2 && !io::is_recording(settings.source[0]));
}

void match(Inspection& inspection) {
  Pipeline pipeline(inspection.options, inspection.pair.calibration);
  if (!inspection.mask.empty()) pipeline.set_mask(inspection.mask);
  inspection.result = pipeline.process(inspection.pair.left.view(), inspection.pair.right.view());
  inspection.engine = pipeline.engine_name();
}

void process(Inspection& inspection) {
  inspection.pair.disparity.empty() ? match(inspection) : use_given_disparity(inspection);
  inspection.threads = resolve_threads(inspection.options.threads);
  inspection.warnings = inspection.pair.warnings;
  inspection.warnings.insert(inspection.warnings.end(), inspection.result.warnings.begin(),
                             inspection.result.warnings.end());
  find_damage_or_warn(inspection.result, inspection.pair.calibration, inspection.options.damage,
                      inspection.options.threads, inspection.damage, inspection.health, inspection.warnings);
  if (inspection.pair.calibration && inspection.result.roll_found) {
    inspection.plane = ground_plane(inspection.result.geometry.plane, *inspection.pair.calibration);
  }
}

void reject_flight_options(const FlightSettings& settings) {
  const auto reject = [](const char* option) { fail(option, " is for recordings only; LEFT and RIGHT are one pair"); };
  if (settings.resume) reject("--resume");
  if (settings.from != 0) reject("--from");
  if (settings.to) reject("--to");
  if (settings.every != 1) reject("--every");
  if (!settings.track.file.empty()) reject("--track");
  if (settings.trajectory) reject("--trajectory");
  if (settings.map) reject("--map");
  if (settings.candidates) reject("--candidates");
  if (!settings.auto_mask) reject("--no-auto-mask");
  if (settings.track.offset_s != 0) reject("--track-offset");
  if (settings.track.offset_sd_s != TrackSettings().offset_sd_s) reject("--track-offset-sd");
  if (settings.track.mount_yaw_deg != 0) reject("--mount-yaw");
  const SourceSettings& source = settings.source_settings;
  if (!source.camera_size.empty()) reject("--camera-size");
  if (source.layout != SourceSettings().layout) reject("--layout");
  if (!source.topics.empty()) reject("--topics");
  if (source.max_time_difference_ms != SourceSettings().max_time_difference_ms) reject("--max-time-difference");
  if (source.rate_hz != 0) reject("--rate");
  if (!settings.disparity.empty() && !settings.processing.rig_bias.empty()) {
    fail("--rig-bias corrects the disparities of this program; it cannot be used with --disparity");
  }
}

PairFiles pair_files(const FlightSettings& settings) {
  const bool has_right = settings.source.size() > 1;
  if (!has_right && (settings.height_m || settings.pitch_deg)) {
    fail("--height and --pitch need RIGHT: they are used to find the road in the pair");
  }
  return {settings.source[0], has_right ? settings.source[1] : "", settings.calibration, settings.disparity};
}

void inspect_pair(const FlightSettings& settings) {
  reject_flight_options(settings);
  require_no_other_owner(settings.output, OutputOwner::pair);
  const bool wants_cloud = std::find(settings.write.begin(), settings.write.end(), "cloud") != settings.write.end();
  Inspection inspection;
  inspection.options = make_options(settings);
  inspection.preset = settings.processing.preset;
  inspection.files = pair_files(settings);
  inspection.pair = read_pair(inspection.files, inspection.options.threads);
  if (wants_cloud && !inspection.pair.calibration) fail("--write cloud needs --calibration");
  inspection.head = settings.head;
  inspection.mask_file = settings.mask;
  inspection.rig_bias_file = settings.processing.rig_bias;
  inspection.mask = read_ignored(settings);
  require_mask_size(settings, inspection.mask, inspection.pair.left.width, inspection.pair.left.height);
  if (!sets_white_level(settings.processing)) inspection.options.white_level = inspection.pair.white_level;

  io::OutputFolder folder(settings.output);  // fails early
  for (const std::string& input : input_files(settings)) folder.protect(input);
  process(inspection);
  auto stop = std::make_unique<StopSignals>();  // staged files do not stay
  add_result_files(settings.write, inspection, folder);
  const std::string result = result_json(inspection);
  folder.add("result.json", result);
  if (stop->wait(0)) throw Interrupted{"interrupted; nothing was written"};
  folder.commit();
  stop.reset();

  if (settings.json) fmt::print("{}", result);
  if (!settings.json && !settings.quiet) fmt::print("{}", summary(inspection, folder.path()));
}

void inspect(InspectArguments arguments) {
  assign_names(arguments);
  is_one_pair(arguments.settings) ? inspect_pair(arguments.settings) : inspect_flight(arguments.settings);
}

constexpr const char* inspect_footer =
    R"(Output of a pair: disparity.tiff, sigma.tiff (standard error of the disparity, px) and transformed.tiff (32-bit float,
NaN invalid), disparity.png (16 bit, value / 256 px), sheet.png, result.json, damages.json, damages.csv, damage.png (ids),
overlay.png, report.html; with a calibration cloud.ply (camera frame, m) and road_cloud.ply (the road is z = 0). --write
selects: disparity, sigma, transformed, sheet, cloud, damages, overlay, report. result.json says what each file is.

Output of a recording: damages.csv (one row per damage of the road, worst first), candidates.csv, sightings.csv (one row
per damage and frame), frames.csv, pose.csv (smoothed roll, pitch, height), summary.json, report.html, an image of each
damage in damages/, and the files selected with --write; with --track also segments.csv (every 20 m), flight.gpkg, the same
as GeoJSON; with --map also map/ (frames are matched twice). --resume continues after Ctrl-C or a kill.

SOURCE is a folder (left/ right/, image_2/ image_3/, image_0/ image_1/, cam0/data cam1/data, or images named L… and R…),
a list (.txt or .csv with lines "left right [seconds]"), a video with both views in one image, or a ROS bag (.bag, .mcap,
.db3 or the folder of rosbag2); or two folders or two videos, left and right.

Calibration formats, recognised by content: plain YAML (focal_px, cx_px, cy_px, baseline_m, width, height), OpenCV stereo
YAML or XML, ROS camera_info and EuRoC sensor.yaml (two files, left then right), Kalibr camchain.yaml, ZED SN*.conf,
RealSense and DepthAI JSON, COLMAP cameras.txt (then rigs.txt or images.txt), KITTI calib*.txt, Middlebury calib.txt,
K.txt. Unrectified images are rectified. Metric results need it.

Examples:
  roadstereo inspect left.png right.png --calibration calibration.yaml --output out
  roadstereo inspect flight/ --calibration left.yaml --calibration right.yaml --every 5 --write sheet --output out)";

void add_input_options(CLI::App& command, InspectArguments& arguments) {
  command
      .add_option("SOURCE", arguments.names,
                  "A recording; or LEFT and RIGHT: two images of equal size (PNG, JPEG, TIFF, PGM or PPM; 8 or 16 bit)")
      ->required();
  add_calibration_option(command, arguments.settings.calibration);
  command
      .add_option("--disparity", arguments.settings.disparity,
                  "Disparity map of LEFT instead of matching (float TIFF, PFM, or PNG / 256); RIGHT is optional")
      ->type_name("FILE");
  command
      .add_option("--mask", arguments.settings.mask,
                  "Image of the size of the rectified frames; its white pixels (255) are left out, e.g. a bonnet")
      ->type_name("FILE");
  command
      .add_option("--height", arguments.settings.height_m,
                  "Expected height of the camera above the road; needs a calibration")
      ->type_name("M");
  command
      .add_option("--pitch", arguments.settings.pitch_deg,
                  "Expected pitch of the camera below the horizon, 90 straight down; needs a calibration")
      ->type_name("DEG");
}

void add_output_options(CLI::App& command, FlightSettings& settings) {
  command.add_option("--output", settings.output, "Output folder; created if missing")->type_name("DIR")->required();
  command.add_flag("--quiet", settings.quiet, "Print nothing on success");
  command.add_flag("--json", settings.json, "Print result.json (recordings: summary.json) instead of the summary");
}

void add_track_options(CLI::App& command, TrackSettings& track, bool& candidates) {
  command
      .add_option(
          "--track", track.file,
          "GNSS track: GPX, CSV with time,lat,lon[,alt,heading], NMEA, DJI SRT, PX4 CSV, or a ROS bag with NavSatFix; "
          "writes GIS files of frames and damages")
      ->type_name("FILE");
  command
      .add_option("--track-offset", track.offset_s,
                  "Seconds added to the times of the frames, e.g. the start since 1970 if a recording counts from 0")
      ->type_name("S");
  command
      .add_option("--track-offset-sd", track.offset_sd_s,
                  "Expected error of --track-offset, for --trajectory; 0.01: synchronised clocks")
      ->capture_default_str()
      ->type_name("S");
  command.add_flag("--candidates", candidates, "Add a layer of candidates to the GIS files");
  command
      .add_option("--mount-yaw", track.mount_yaw_deg,
                  "Yaw of the camera relative to the direction of travel, clockwise; ruts run along that")
      ->type_name("DEG");
}

void add_flight_options(CLI::App& command, FlightSettings& settings) {
  command.add_flag(
      "--trajectory", settings.trajectory,
      "Estimate the motion of the camera and close loops, with --track in UTM: trajectory_kitti.txt and others");
  command.add_flag("--map", settings.map,
                   "Map of the road along the trajectory, in map/: rasters, damages, profiles (as roadstereo map)");
  command.add_flag_callback(
      "--no-auto-mask", [&settings] { settings.auto_mask = false; },
      "Do not mask parts of the picture that never move, such as a bonnet; --mask implies this");
  command.add_flag("--resume", settings.resume, "Continue the flight in the output folder");
  command.add_option("--from", settings.from, "First frame of the recording, from 0")->type_name("N");
  command.add_option("--to", settings.to, "Last frame of the recording, inclusive")->type_name("N");
  command.add_option("--every", settings.every, "Process every N-th frame")->type_name("N");
  command
      .add_option(
          "--write", settings.write,
          "Files, comma-separated. Of a pair: see below, default all; of every frame of a recording: disparity, "
          "transformed, sheet, cloud, overlay, mcap (one flight.mcap of ROS 2 messages), default none")
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "inspect", "Compute disparity, roll, transformed disparity and damage of a stereo pair or a recording");
  command->footer(inspect_footer);
  const auto arguments = std::make_shared<InspectArguments>();
  add_input_options(*command, *arguments);
  add_output_options(*command, arguments->settings);
  add_head_options(*command, arguments->settings.head);
  add_flight_options(*command, arguments->settings);
  add_track_options(*command, arguments->settings.track, arguments->settings.candidates);
  add_source_options(*command, arguments->settings.source_settings);
  add_processing_options(*command, arguments->settings.processing);
  command->callback([arguments] { inspect(*arguments); });
}

}  // namespace roadstereo::cli
