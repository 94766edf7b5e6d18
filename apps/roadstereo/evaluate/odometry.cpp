#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/odometry_trials.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "finite_values.hpp"
#include "flight_path.hpp"
#include "roadstereo/error.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {
namespace {

struct OdometryArguments {
  OdometryTrialOptions trials;
  bool flight = false;
  std::string json;
};

constexpr const char* odometry_note =
    R"(trans, rot: errors of the motion over pieces of 10, 20, … 50 m of path (short paths: tenths of it), as KITTI odometry
defines them. turned: trans without the constant turn about x and y between the axes of the true poses and the estimated
motion. ATE: RMS of the positions after a rigid alignment, of the path. link: displacement of the pixels of a frame by the
error of its link; roadstereo links to a reference up to several frames before. link/σ, pose/σ: RMS of the whitened errors
of links, and of poses against the first frame, 1 if their covariances are right. share: of the time of matching.
)";

Table odometry_table(const OdometryTrials& trials, const std::string& title) {
  Table table{title,
              {{"method", "method"},
               {"trans %", "translation_percent"},
               {"rot °/m", "rotation_deg_per_m"},
               {"turned %", "turned_percent"},
               {"ATE %", "ate_percent"},
               {"link px", "link_median_px"},
               {"95 %", "link_p95_px"},
               {"link/σ", "link_rms_sd"},
               {"pose/σ", "pose_rms_sd"},
               {"lost", "lost"},
               {"ms", "median_ms"},
               {"share %", "share_percent"}},
              {}};
  for (const OdometryTrial& trial : trials.methods) {
    const bool linked = !trial.link_errors_px.empty();
    table.rows.push_back({trial.method, Cell(trial.score.translation_percent, 3),
                          Cell(trial.score.rotation_deg_per_m, 4), Cell(trial.score.turned_percent, 3),
                          Cell(trial.score.absolute_percent, 3), Cell(linked ? median(trial.link_errors_px) : NAN, 3),
                          Cell(linked ? quantile(trial.link_errors_px, 0.95) : NAN, 3),
                          Cell(rms(trial.link_errors_sd), 2), Cell(rms(trial.pose_errors_sd), 2),
                          Cell(static_cast<double>(trial.lost), 0),
                          Cell(trial.median_ms > 0 ? trial.median_ms : NAN, 1),
                          Cell(trial.median_ms > 0 ? 100 * trial.median_ms / trials.matching_ms : NAN, 0)});
  }
  return table;
}

nlohmann::json loops_json(const OdometryTrials& trials) {
  if (!trials.graph) return nullptr;
  const PoseGraphResult::Misclosure misclosure = trials.graph->misclosure();
  return {{"found", trials.graph->loops.size()},
          {"used", trials.graph->loops_used()},
          {"compared", trials.compared},
          {"misclosure_before_px", misclosure.before_px},
          {"misclosure_after_px", misclosure.after_px}};
}

void run(const OdometryArguments& arguments) {
  const OdometryTrialOptions& options = arguments.trials;
  if (options.folder.empty() && !arguments.flight) fail("evaluate odometry needs DIR or --flight");
  const OdometryTrials trials = run_odometry_trials(options);
  const std::string source = arguments.flight
                                 ? fmt::format("{} frames of scene {}, {}, flight {}, noise {}", options.frames,
                                               options.scene, options.size, options.flight, options.noise_grey)
                                 : options.folder;
  const Table table = odometry_table(trials, fmt::format("{}: {:.1f} m", source, trials.methods[0].score.path_m));
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "odometry"},
                                  {"rows", table.json()},
                                  {"path_m", trials.methods[0].score.path_m},
                                  {"axes_turn_rad", trials.methods[0].score.axes_turn_rad},
                                  {"matching_ms", trials.matching_ms},
                                  {"loops", loops_json(trials)},
                                  {"missing_peers", trials.missing},
                                  {"links", trials.links},
                                  {"links_with_offset", trials.with_offset},
                                  {"offset_px", trials.offset_px}});
  }
  fmt::print("{}\n", table.text());
  if (trials.with_offset > 0) {
    fmt::print("Disparities are short by an offset at infinity: {:.2f} px (median), undone in {} of {} links.\n",
               trials.offset_px, trials.with_offset, trials.links);
  }
  if (trials.graph) {
    const PoseGraphResult::Misclosure misclosure = trials.graph->misclosure();
    fmt::print("Loops: {} of {} used, from {} pairs of frames; misclosure {:.2f} px before, {:.2f} px after.\n",
               trials.graph->loops_used(), trials.graph->loops.size(), trials.compared, misclosure.before_px,
               misclosure.after_px);
  }
  for (const std::string& peer : trials.missing) fmt::print("NOT COMPARED, {}.\n", peer);
  fmt::print("{}", odometry_note);
}

}  // namespace

void add_odometry(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("odometry", "Trajectory against known poses: a recording, or a rendered flight");
  const auto arguments = std::make_shared<OdometryArguments>();
  OdometryTrialOptions& trials = arguments->trials;
  CLI::Option* folder =
      command->add_option("DIR", trials.folder,
                          "Recording with poses.txt (KITTI: camera to world, a 3×4 row a frame) and calibration.yaml");
  add_calibration_option(*command, trials.calibration);
  command->get_option("--calibration")->needs(folder);
  command
      ->add_option_function<std::string>(
          "--flight",
          [arguments](const std::string& text) {
            arguments->flight = true;
            arguments->trials.flight = text;
          },
          "Renders a flight")
      ->type_name("SPEC");
  command->add_option("--scene", trials.scene, "Name of the scene of the flight")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--frames", trials.frames, "Number of frames of the flight")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--size", trials.size, "Image size of the flight")->type_name("WxH")->capture_default_str();
  command->add_option("--noise", trials.noise_grey, "Noise of the flight, 8-bit grey levels")
      ->type_name("GREY")
      ->capture_default_str();
  command->add_option("--supersampling", trials.supersampling, "Rays per pixel and axis of the renderer")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--preset", trials.preset, "default, fast or paper")->type_name("NAME")->capture_default_str();
  command
      ->add_option(
          "--peers", trials.peers,
          "Compared with: flow (OpenCV's optical flow and PnP), rgbd (its RgbdOdometry), open3d, colmap (minutes)")
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all()
      ->capture_default_str();
  for (const char* of_flight : {"--flight", "--scene", "--frames", "--size", "--noise", "--supersampling"}) {
    folder->excludes(of_flight);
  }
  add_method_options(*command, trials.methods);
  command->footer(flight_help() + "\nExamples:\n  roadstereo evaluate odometry drive/\n" +
                  "  roadstereo evaluate odometry --flight loop=300 --json odometry.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
