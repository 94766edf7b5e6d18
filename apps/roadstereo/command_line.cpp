#include "command_line.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "commands.hpp"
#include "inspect_flight.hpp"
#include "log_stderr.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/version.hpp"
#include "unknown_word.hpp"

namespace {

constexpr int exit_bad_input = 2;
constexpr int exit_failure = 1;
constexpr int exit_interrupted = 130;  // as shells report Ctrl-C

constexpr const char* footer =
    "Example: render a road and inspect it\n"
    "  roadstereo synth --scene demo --output road\n"
    "  roadstereo inspect road/left.png road/right.png --calibration road/calibration.yaml --output out\n"
    "\n"
    "Exit codes: 0 success; 2 wrong usage or invalid input; 1 other errors, e.g. a full disk;\n"
    "130 inspect or map interrupted by Ctrl-C.";

/// Prints an error message in one line. Control characters, e.g. of file names, do not reach the terminal.
int report_error(std::string message, int exit_code) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::replace_if(
      message.begin(), message.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; }, '?');
  roadstereo::cli::log_stderr("roadstereo: {}\n", message);
  return exit_code;
}

/// Returns the help command for a wrong command line.
std::string help_command(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "roadstereo --help" : "roadstereo " + chosen.front()->get_name() + " --help";
}

/// Flushes standard output so that a write error is reported.
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
    const int exit_code = app.exit(wanted);
    std::cout.flush();
    if (!std::cout) throw roadstereo::SystemError("standard output cannot be written");
    return exit_code;
  } catch (const CLI::ParseError& error) {
    const std::string unknown = roadstereo::cli::unknown_word(app);
    return report_error(fmt::format("{} (see {})", unknown.empty() ? error.what() : unknown, help_command(app)),
                        exit_bad_input);
  }
}

void describe(CLI::App& app) {
  app.name("roadstereo");
  app.description(
      "roadstereo: dense stereo matching for road inspection.\n"
      "Computes from a stereo pair of a road: a sub-pixel disparity map, the roll angle, the road model,\n"
      "the transformed disparity map, in which intact road has a constant value, and the road damage.");
  app.footer(footer);
  app.set_version_flag("--version", std::string("roadstereo ") + roadstereo::version);
  app.require_subcommand(0, 1);  // a missing one is checked after parsing, for better messages
  roadstereo::cli::add_inspect(app);
  roadstereo::cli::add_live(app);
  roadstereo::cli::add_damage(app);
  roadstereo::cli::add_map(app);
  roadstereo::cli::add_synth(app);
  roadstereo::cli::add_limits(app);
  roadstereo::cli::add_options(app);
  roadstereo::cli::add_engines(app);
  roadstereo::cli::add_completion(app);
  roadstereo::cli::add_benchmark(app);
#ifdef ROADSTEREO_WITH_EVALUATE
  roadstereo::cli::add_evaluate(app);
#endif
}

/// Silences the logging of OpenCV and FFmpeg unless the user has set the variables; errors are reported by this
/// program.
void quieten_decoders() {
  constexpr int keep_what_is_set = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", keep_what_is_set);  // FFmpeg's AV_LOG_QUIET
  if (std::getenv("OPENCV_LOG_LEVEL") == nullptr) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  }
}

/// Makes a file above the limit of its size (ulimit -f) an error, as a full disk is, instead of the end of the process.
void report_large_files() {
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

int roadstereo::cli::run_command_line(int argc, char** argv) {
  try {
    quieten_decoders();
    report_large_files();
    CLI::App app;
    describe(app);
    return run(app, argc, argv);
  } catch (const roadstereo::SystemError& error) {
    return report_error(error.what(), exit_failure);
  } catch (const roadstereo::Error& error) {
    return report_error(error.what(), exit_bad_input);
  } catch (const roadstereo::cli::Interrupted& interrupted) {
    return report_error(interrupted.message, exit_interrupted);
  } catch (const std::bad_alloc&) {
    return report_error("out of memory", exit_failure);
  } catch (const std::exception& error) {
    return report_error(error.what(), exit_failure);
  }
}
