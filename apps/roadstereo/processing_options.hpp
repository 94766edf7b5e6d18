#pragma once

#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// How the command line wants pairs to be treated.
struct ProcessingSettings {
  std::string preset = "default";
  std::string engine = "auto";
  int threads = 0;
  std::vector<std::string> settings;  ///< "key=value"
};

void add_processing_options(CLI::App& command, ProcessingSettings& processing);

/// The options that it asks for. Throws Error naming what is unknown or out of range.
PipelineOptions make_options(const ProcessingSettings& processing);

/// Whether white is set by hand: then it is not looked for in the pictures.
bool sets_white_level(const ProcessingSettings& processing);

/// Worker threads that these options use.
int used_threads(const PipelineOptions& options);

/// Every key of --set with its default and its meaning.
std::string settings_help();

}  // namespace roadstereo::cli
