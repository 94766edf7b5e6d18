#pragma once

#include <string>
#include <vector>

#include "pair_source.hpp"
#include "roadstereo/pipeline.hpp"

namespace CLI {
class App;
}

namespace roadstereo::cli {

/// What the command line says about the pipeline.
struct MethodSettings {
  int threads = 0;
  std::vector<std::string> settings;  ///< KEY=VALUE
};

/// Adds --threads and --set.
void add_method_options(CLI::App& command, MethodSettings& settings);

/// Who is compared: the presets, then OpenCV's matchers.
std::vector<std::string> method_names();

/// Where a method stands among them.
std::size_t method_index(const std::string& name);

/// A rectified pair, and how far to search it.
struct MethodTask {
  const StereoPair& pair;
  int disparities = 128;     ///< for OpenCV's matchers, and for the presets without a road
  bool shows_a_road = true;  ///< false: no perspective transformation
};

/// The options of that preset for the pair, with what the command line says on top.
PipelineOptions method_options(const std::string& preset_name, const MethodTask& task, const MethodSettings& settings);

/// Disparities of one pair, nothing carried over from another: by the preset of that name on the pair as it is, or by
/// OpenCV's matcher of that name on the same pair in grey.
Image<float> run_method(const std::string& name, const MethodTask& task, const MethodSettings& settings);

/// Those of every method, in the order of method_names().
std::vector<Image<float>> run_methods(const MethodTask& task, const MethodSettings& settings);

}  // namespace roadstereo::cli
