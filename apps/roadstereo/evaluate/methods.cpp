#include "evaluate/methods.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "evaluation/peer_matchers.hpp"
#include "settings.hpp"

namespace roadstereo::cli {
namespace {

Image<float> run_preset(const std::string& name, const MethodTask& task, const MethodSettings& settings) {
  Pipeline pipeline(method_options(name, task, settings), task.pair.calibration);
  return pipeline.process(task.pair.left.view(), task.pair.right.view()).disparity;
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
  std::vector<std::string> names{"paper", "default", "fast"};
  names.insert(names.end(), io::peer_names().begin(), io::peer_names().end());
  return names;
}

std::size_t method_index(const std::string& name) {
  const std::vector<std::string> names = method_names();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

PipelineOptions method_options(const std::string& preset_name, const MethodTask& task, const MethodSettings& settings) {
  PipelineOptions options = preset(preset_name);
  options.threads = settings.threads;
  options.white_level = task.pair.white_level;
  if (!task.is_road) {
    options.perspective.enabled = false;
    options.perspective.disparities = task.disparities;
  }
  apply_settings(settings.settings, options);
  return options;
}

Image<float> run_method(const std::string& name, const MethodTask& task, const MethodSettings& settings) {
  const auto& baselines = io::peer_names();
  const bool is_baseline = std::find(baselines.begin(), baselines.end(), name) != baselines.end();
  return is_baseline ? run_baseline(name, task) : run_preset(name, task, settings);
}

std::vector<Image<float>> run_methods(const MethodTask& task, const MethodSettings& settings) {
  std::vector<Image<float>> maps;
  for (const std::string& name : method_names()) maps.push_back(run_method(name, task, settings));
  return maps;
}

}  // namespace roadstereo::cli
