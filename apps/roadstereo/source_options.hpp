#pragma once

#include <string>
#include <vector>

#include "roadstereo/io/frame_source.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// What the command line says about a recording or a camera.
struct SourceChoice {
  std::string layout = "auto";
  std::vector<std::string> topics;
  double max_time_difference_ms = 5;
  double rate_hz = 0;
  std::string camera_size;  ///< "WxH" of the picture that holds both views; empty leaves the default
};

/// --calibration: none, one file, or the two of a ROS pair.
void add_calibration_option(CLI::App& command, std::vector<std::string>& calibration);

void add_source_options(CLI::App& command, SourceChoice& choice);

/// The same, checked. Throws Error naming what is unknown or out of range.
io::SourceOptions make_source_options(const SourceChoice& choice);

}  // namespace roadstereo::cli
