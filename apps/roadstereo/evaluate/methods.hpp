#pragma once

#include <string>
#include <vector>

#include "evaluate/given_maps.hpp"
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
  std::vector<GivenMaps> maps;        ///< compared, too
};

/// Adds --threads and --set.
void add_method_options(CLI::App& command, MethodSettings& settings);

/// Names of the compared methods: the presets, then OpenCV's matchers.
std::vector<std::string> method_names();

/// The same, then the names of the given maps.
std::vector<std::string> method_names(const MethodSettings& settings);

/// Whether a method is a preset.
bool is_preset(const std::string& name);

/// Index of a method in method_names(); their number if there is none of that name.
std::size_t method_index(const std::string& name);

/// Rectified pair and its disparity range.
struct MethodTask {
  const StereoPair& pair;
  int disparities = 128;  ///< for OpenCV's matchers, and for the presets unless `is_road`
  bool is_road = true;    ///< false: no perspective transformation
  std::string frame{};    ///< name of its files of given maps
};

/// The options with those of the command line applied. Throws Error when one is unknown or out of range.
PipelineOptions with_settings(PipelineOptions options, const MethodSettings& settings);

/// Options of a preset for the pair, with those of the command line applied.
PipelineOptions method_options(const std::string& preset_name, const MethodTask& task, const MethodSettings& settings);

/// Compute the disparities of one pair, without state from other pairs: by the preset of that name, or by OpenCV's
/// matcher of that name on the grey images.
Image<float> run_method(const std::string& name, const MethodTask& task, const MethodSettings& settings);

/// Disparities of every method.
struct MethodMaps {
  std::vector<Image<float>> maps;          ///< in the order of method_names(settings)
  std::vector<std::string> without_shift;  ///< presets that did not transform the pair, since they found no road
};
MethodMaps run_methods(const MethodTask& task, const MethodSettings& settings);

}  // namespace roadstereo::cli
