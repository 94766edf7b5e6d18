#pragma once

#include <string>
#include <vector>

#include "roadstereo/io/frame_source.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Command line options of a recording or a camera.
struct SourceSettings {
  std::string layout = "auto";
  std::vector<std::string> topics;
  double max_time_difference_ms = 5;
  double rate_hz = 0;
  std::string camera_size;  ///< "WxH" of the image with both views; empty: default
};

/// Adds --calibration: one file, or two, left and right.
void add_calibration_option(CLI::App& command, std::vector<std::string>& calibration);

void add_source_options(CLI::App& command, SourceSettings& choice);

/// Returns the checked options. Throws Error naming the option that is unknown or out of range.
io::SourceOptions make_source_options(const SourceSettings& choice);

}  // namespace roadstereo::cli
