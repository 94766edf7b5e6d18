#include "evaluate/methods.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "evaluation/peer_matchers.hpp"
#include "settings.hpp"

namespace roadstereo::cli {
namespace {

constexpr std::array presets{"paper", "default", "fast"};

struct PresetMap {
  Image<float> disparity;
  bool shifted = false;
};

PresetMap run_preset(const std::string& name, const MethodTask& task, const MethodSettings& settings) {
  Pipeline pipeline(method_options(name, task, settings), task.pair.calibration);
  const FrameResult& result = pipeline.process(task.pair.left.view(), task.pair.right.view());
  return {result.disparity, result.shift.enabled};
}

Image<float> run_baseline(const std::string& name, const MethodTask& task) {
  GreyImage left, right;
  to_grey(task.pair.left.view(), task.pair.white_level, left);
  to_grey(task.pair.right.view(), task.pair.white_level, right);
  io::PeerMatcher matcher(name, task.disparities);
  matcher.set_pair(left, right);
  matcher.match();
  return matcher.disparity();
}

}  // namespace

void add_method_options(CLI::App& command, MethodSettings& settings) {
  command.add_option("--threads", settings.threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--set", settings.settings, "Set an option of every preset; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

std::vector<std::string> method_names() {
  std::vector<std::string> names(presets.begin(), presets.end());
  names.insert(names.end(), io::peer_names().begin(), io::peer_names().end());
  return names;
}

std::vector<std::string> method_names(const MethodSettings& settings) {
  std::vector<std::string> names = method_names();
  for (const GivenMaps& maps : settings.maps) names.push_back(maps.name);
  return names;
}

bool is_preset(const std::string& name) {
  return std::find(presets.begin(), presets.end(), name) != presets.end();
}

std::size_t method_index(const std::string& name) {
  const std::vector<std::string> names = method_names();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

PipelineOptions with_settings(PipelineOptions options, const MethodSettings& settings) {
  options.threads = settings.threads;
  apply_settings(settings.settings, options);
  options.validate();
  return options;
}

PipelineOptions method_options(const std::string& preset_name, const MethodTask& task, const MethodSettings& settings) {
  PipelineOptions options = preset(preset_name);
  options.white_level = task.pair.white_level;
  if (!task.is_road) {
    options.perspective.enabled = false;
    options.perspective.disparities = task.disparities;
  }
  return with_settings(std::move(options), settings);
}

Image<float> run_method(const std::string& name, const MethodTask& task, const MethodSettings& settings) {
  const auto& baselines = io::peer_names();
  if (std::find(baselines.begin(), baselines.end(), name) != baselines.end()) return run_baseline(name, task);
  for (const GivenMaps& maps : settings.maps) {
    if (maps.name == name) return read_given_map(maps, task.frame, task.pair.left.width, task.pair.left.height);
  }
  return run_preset(name, task, settings).disparity;
}

MethodMaps run_methods(const MethodTask& task, const MethodSettings& settings) {
  MethodMaps all;
  for (const std::string& name : method_names(settings)) {
    if (!is_preset(name)) {
      all.maps.push_back(run_method(name, task, settings));
      continue;
    }
    PresetMap preset_map = run_preset(name, task, settings);
    all.maps.push_back(std::move(preset_map.disparity));
    if (task.is_road && !preset_map.shifted) all.without_shift.push_back(name);
  }
  return all;
}

}  // namespace roadstereo::cli
