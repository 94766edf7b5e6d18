#pragma once

#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Command line options of the pipeline.
struct ProcessingSettings {
  std::string preset = "default";
  std::string scope = "road";  ///< or "scene"
  std::string engine = "auto";
  int threads = 0;
  std::vector<std::string> settings;  ///< "key=value"
  std::string severity = "d6433";     ///< or a file of severities
  std::string rig_bias;               ///< file of `io::read_rig_bias`; empty: none
};

/// Adds --severity.
void add_severity_option(CLI::App& command, std::string& severity);

void add_processing_options(CLI::App& command, ProcessingSettings& processing);

/// Returns the pipeline options. Throws Error naming the option that is unknown or out of range.
PipelineOptions make_options(const ProcessingSettings& processing);

/// Returns whether the white level is set by the user.
bool sets_white_level(const ProcessingSettings& processing);

}  // namespace roadstereo::cli
