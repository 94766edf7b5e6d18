// Rendered pairs as files, for matchers of others.
#pragma once

#include <string>

#include "pair_source.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace roadstereo::cli {

/// Add --write-pairs DIR: the pairs of the experiment are written instead of matched. It excludes --maps and --json,
/// which must have been added.
CLI::Option* add_write_pairs_option(CLI::App& command, std::string& folder);

/// Stage left/FRAME.png, right/FRAME.png and, if there is a calibration, calibration/FRAME.yaml.
void add_pair(const std::string& frame, const StereoPair& pair, io::OutputFolder& folder);

}  // namespace roadstereo::cli
