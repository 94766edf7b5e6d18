#include "live/live_command.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <optional>

#include "live/live_server.hpp"
#include "live/live_session.hpp"
#include "live/live_summary.hpp"
#include "live/terminal_line.hpp"
#include "log_stderr.hpp"
#include "processing_options.hpp"
#include "roadstereo/error.hpp"
#include "source_options.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {
namespace {

/// Command line of `live`.
struct LiveCommandArguments {
  std::vector<std::string> names;
  std::vector<std::string> calibration;
  SourceSettings source;
  ProcessingSettings processing;
  std::string record;
  std::string serve;
  std::optional<std::uint32_t> dds_domain;
  bool trajectory = false;
  double max_age_ms = 500;
  bool loop = false;
  bool auto_mask = true;
  std::int64_t frames = 0;
  double seconds = 0;
  bool json = false;
};

LiveOptions live_options(const LiveCommandArguments& arguments) {
  if (!std::isfinite(arguments.max_age_ms)) fail("--max-age is ", arguments.max_age_ms, "; it must be a finite number");
  if (!std::isfinite(arguments.seconds)) fail("--seconds is ", arguments.seconds, "; it must be a number");
  if (arguments.calibration.size() > 2) fail("--calibration needs one file, or two: left and right");
  LiveOptions options;
  options.processing.pipeline = make_options(arguments.processing);
  options.processing.find_white_level = !sets_white_level(arguments.processing);
  options.processing.auto_mask = arguments.auto_mask;
  options.processing.dds_domain = arguments.dds_domain;
  options.processing.trajectory = arguments.trajectory;
  options.capture.rate_hz = arguments.source.rate_hz;
  options.capture.loop = arguments.loop;
  options.calibration = arguments.calibration;
  options.max_age_s = arguments.max_age_ms / 1000;
  options.record = arguments.record;
  return options;
}

/// Runs until the end of the source, the frame or time limit, or a signal.
void watch(const LiveCommandArguments& arguments, LiveSession& session, Clock::time_point start,
           const StopSignals& signals) {
  constexpr double period_s = 0.05;
  TerminalLine line;
  while (!session.finished()) {
    const LiveStatus status = session.board().status();
    line.show(status);
    if (arguments.frames > 0 && status.counts.shown >= arguments.frames) return;
    if (arguments.seconds > 0 && seconds_between(start, Clock::now()) >= arguments.seconds) return;
    if (signals.wait(period_s)) return;
  }
}

void live(const LiveCommandArguments& arguments, const NamedOpener& opener) {
  std::optional<ServeAddress> address;
  if (!arguments.serve.empty()) address = serve_address(arguments.serve);
  const io::SourceOptions source = make_source_options(arguments.source);
  LiveSession session(live_options(arguments), [&] { return opener(arguments.names, source); });
  std::unique_ptr<LiveServer> server;
  if (address) {
    server = std::make_unique<LiveServer>(*address, session.board());
    log_stderr("roadstereo: serving {} at {}\n", session.description(), server->url());
  }
  auto signals = std::make_unique<StopSignals>();  // until here Ctrl-C ends the program
  const Clock::time_point start = Clock::now();
  session.start();
  watch(arguments, session, start, *signals);
  signals.reset();
  session.stop();
  const std::string last_message = session.board().status().message;
  std::exception_ptr failure;
  try {
    session.end();
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  server.reset();
  LiveSummary summary{session.description(), seconds_between(start, Clock::now()), session.board().status(),
                      session.board().latency_of_all()};
  fmt::print("{}", arguments.json ? summary_json(summary) : summary_text(summary));
  if (failure) std::rethrow_exception(failure);
  const std::string& stopped = summary.status.recording.message;
  if (!stopped.empty()) fail<SystemError>(arguments.record, ": ", stopped);
  const LiveCounts& counts = summary.status.counts;
  if (counts.rejected > 0 && counts.rejected == counts.taken) {
    fail("none of the ", counts.taken, " pairs could be matched: ", last_message);
  }
}

constexpr const char* footer =
    R"(Processes the newest pair: pairs that arrive during processing are dropped and counted, and pairs older than --max-age
are not processed. A recording is played back in real time, at its own times or at --rate. A lost camera is reconnected.

--record DIR writes the raw pairs losslessly as left/NNNNNN.png and right/NNNNNN.png with times.txt and
calibration.yaml, for roadstereo inspect DIR. It never delays processing: if the disk is too slow, pairs are skipped and counted.

--serve PORT serves a web page on this machine: left image with outlined damage, transformed disparity, roll, height,
frame rate, latency, age, and the list of damages. With a HOST (0.0.0.0: all addresses) other machines can open it with
the token in the printed address. Port 0: any free port.

--trajectory follows the camera from frame to frame; the page shows its path from above. It takes at most 30 % of the time
and skips frames rather than delay them. A frame that cannot be linked begins a new path.

--dds DOMAIN (ROS_DOMAIN_ID, usually 0) publishes what inspect --write mcap writes (docs/file_formats.md): image, disparities,
points, damages, odometry and /tf. A message is dropped rather than waited for; odometry is computed for subscribers only, and
as for --trajectory.

The status line shows the latency (median/95th percentile), the height, and the damages (current/total). Ctrl-C stops and
prints a summary.

Examples:
  roadstereo live /dev/video0 --calibration rig.yaml --serve 8080
  roadstereo live flight.mp4 --calibration rig.yaml --loop --serve 0.0.0.0:8080
  roadstereo live /dev/video0 --calibration rig.yaml --record flight1
  roadstereo live /dev/video0 --calibration rig.yaml --dds 0)";

void add_options(CLI::App& command, LiveCommandArguments& arguments) {
  command.add_option("SOURCE", arguments.names, "Camera, video, folder, list, bag or pipeline; or two: left and right")
      ->required()
      ->expected(1, 2);
  add_calibration_option(command, arguments.calibration);
  command.add_option("--record", arguments.record, "New folder for the raw pairs")
      ->type_name("DIR")
      ->check([](const std::string& name) { return name.empty() ? "the name of the folder is empty" : ""; });
  command.add_option("--serve", arguments.serve, "Serve a web page at this port")->type_name("[HOST:]PORT");
  command.add_option("--dds", arguments.dds_domain, "Publish the results to the ROS 2 nodes of this domain, by DDS")
      ->type_name("DOMAIN")
      ->check(CLI::Range(0U, 230U));
  command.add_flag("--trajectory", arguments.trajectory, "Follow the camera and show its path; needs a calibration");
  command.add_option("--max-age", arguments.max_age_ms, "Maximum age of a pair, ms")
      ->type_name("MS")
      ->check(CLI::Range(1.0, 60000.0))
      ->capture_default_str();
  command.add_flag_callback(
      "--no-auto-mask", [&arguments] { arguments.auto_mask = false; },
      "Do not mask parts of the picture that never move, such as a bonnet");
  command.add_flag("--loop", arguments.loop, "Repeat a recording");
  command
      .add_option("--frames", arguments.frames, "Stop after this many processed pairs; pairs in progress are finished")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  command.add_option("--seconds", arguments.seconds, "Stop after this time")
      ->type_name("S")
      ->check(CLI::Range(0.001, 1e7));
  command.add_flag("--json", arguments.json, "Print JSON");
}

}  // namespace

void add_live_command(CLI::App& app, const NamedOpener& opener) {
  CLI::App* command = app.add_subcommand("live", "Process a camera or a recording in real time");
  command->footer(footer);
  const auto arguments = std::make_shared<LiveCommandArguments>();
  add_options(*command, *arguments);
  add_source_options(*command, arguments->source);
  add_processing_options(*command, arguments->processing);
  command->callback([arguments, opener] { live(*arguments, opener); });
}

}  // namespace roadstereo::cli
