#pragma once

#include <string>
#include <vector>

#include "pair_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// Pipeline options of the command line.
struct MethodSettings {
  int threads = 0;
  std::vector<std::string> settings;  ///< KEY=VALUE
};

/// Adds --threads and --set.
void add_method_options(CLI::App& command, MethodSettings& settings);

/// Names of the compared methods: the presets, then OpenCV's matchers.
std::vector<std::string> method_names();

/// Index of a method in method_names(); their number if there is none of that name.
std::size_t method_index(const std::string& name);

/// Rectified pair and its disparity range.
struct MethodTask {
  const StereoPair& pair;
  int disparities = 128;  ///< for OpenCV's matchers, and for the presets if the pair shows no road
  bool is_road = true;    ///< false: no perspective transformation
};

/// Options of a preset for the pair, with those of the command line applied.
PipelineOptions method_options(const std::string& preset_name, const MethodTask& task, const MethodSettings& settings);

/// Compute the disparities of one pair, without state from other pairs: by the preset of that name, or by OpenCV's
/// matcher of that name on the grey images.
Image<float> run_method(const std::string& name, const MethodTask& task, const MethodSettings& settings);

/// Disparities of every method, in the order of method_names().
std::vector<Image<float>> run_methods(const MethodTask& task, const MethodSettings& settings);

}  // namespace roadstereo::cli
