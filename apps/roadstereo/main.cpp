#include <fmt/core.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "commands.hpp"
#include "inspect_flight.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/version.hpp"
#include "say.hpp"

namespace {

constexpr int exit_bad_input = 2;
constexpr int exit_failure = 1;
constexpr int exit_interrupted = 130;  // as shells have it for Ctrl-C

constexpr const char* footer =
    "Example: make a road, inspect it, look at the sheet\n"
    "  roadstereo synth --scene demo --output road\n"
    "  roadstereo inspect road/left.png road/right.png --calibration road/calibration.yaml --output out\n"
    "\n"
    "Exit code: 0 success; 2 wrong usage or unreadable input; 1 anything else (a full disk, for one);\n"
    "130 a flight that Ctrl-C ended.";

/// Says what went wrong in one line, whatever the message's own line breaks.
int report_error(std::string message, int exit_code) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  roadstereo::cli::say("roadstereo: {}\n", message);
  return exit_code;
}

/// The command whose help answers a wrong command line.
std::string help_command(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "roadstereo --help" : "roadstereo " + chosen.front()->get_name() + " --help";
}

/// What waits in the buffer can still meet a full disk.
void flush_output() {
  const bool written = std::fflush(stdout) == 0;
  if (!written) throw roadstereo::SystemError("standard output cannot be written");
}

int run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    flush_output();
    return 0;
  } catch (const CLI::Success& wanted) {  // --help, --version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    return report_error(fmt::format("{} (see {})", error.what(), help_command(app)), exit_bad_input);
  }
}

void describe(CLI::App& app) {
  app.description(
      "roadstereo: dense stereo for road inspection.\n"
      "From a stereo pair of a road: sub-pixel disparities, the roll angle, the road's model, and the\n"
      "transformed disparity map, in which the intact road is flat and damage stands out.");
  app.footer(footer);
  app.set_version_flag("--version", std::string("roadstereo ") + roadstereo::version);
  app.require_subcommand(0, 1);  // none is refused after parsing, when a mistyped one has been named
  roadstereo::cli::add_inspect(app);
  roadstereo::cli::add_live(app);
  roadstereo::cli::add_damage(app);
  roadstereo::cli::add_synth(app);
  roadstereo::cli::add_limits(app);
  roadstereo::cli::add_engines(app);
  roadstereo::cli::add_benchmark(app);
#ifdef ROADSTEREO_WITH_EVALUATE
  roadstereo::cli::add_evaluate(app);
#endif
}

/// OpenCV and FFmpeg say in words of their own, on standard error, what the sentences of errors say. Whoever wants to
/// hear them sets the variables.
void quieten_decoders() {
  constexpr int keep_what_is_set = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", keep_what_is_set);  // FFmpeg's AV_LOG_QUIET
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  }
}

/// Frames come and go by the thousand: their memory is kept for the next one, not given back and asked for again page
/// by page, which costs a millisecond a frame.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int max_kept = 64 << 20;
  ::mallopt(M_MMAP_THRESHOLD, max_kept);
  ::mallopt(M_TRIM_THRESHOLD, 4 * max_kept);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  try {
    quieten_decoders();
    keep_memory();
    CLI::App app;
    describe(app);
    return run(app, argc, argv);
  } catch (const roadstereo::SystemError& error) {
    return report_error(error.what(), exit_failure);
  } catch (const roadstereo::Error& error) {
    return report_error(error.what(), exit_bad_input);
  } catch (const roadstereo::cli::Interrupted&) {
    return report_error("stopped; go on with --resume", exit_interrupted);
  } catch (const std::bad_alloc&) {
    return report_error("out of memory", exit_failure);
  } catch (const std::exception& error) {
    return report_error(error.what(), exit_failure);
  }
}
