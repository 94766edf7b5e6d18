#pragma once

namespace roadstereo::cli {

/// Runs the command line of a process: parses it, runs its command, reports every error in one line on standard error.
/// Returns the exit code.
int run_command_line(int argc, char** argv);

}  // namespace roadstereo::cli
