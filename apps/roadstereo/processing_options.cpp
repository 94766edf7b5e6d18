#include "processing_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/io/severity_file.hpp"
#include "roadstereo/options.hpp"
#include "settings.hpp"

namespace roadstereo::cli {

namespace {

std::string joined_presets() {
  std::string names;
  for (const std::string& name : preset_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

}  // namespace

void add_severity_option(CLI::App& command, std::string& severity) {
  command.add_option("--severity", severity, "Tables of severities: d6433 (ASTM D6433), or a YAML file")
      ->type_name("d6433|FILE")
      ->capture_default_str();
}

void add_processing_options(CLI::App& command, ProcessingSettings& processing) {
  command.add_option("--preset", processing.preset, "Preset of the options: " + joined_presets())
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--scope", processing.scope, "What is matched: road, or scene: vehicles and houses, too (slower)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"road", "scene"}).description(""))
      ->capture_default_str();
  command.add_option("--engine", processing.engine, "Matching engine, see roadstereo engines")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--threads", processing.threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--set", processing.settings, "Set one option, see roadstereo options; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  add_severity_option(command, processing.severity);
  command
      .add_option("--rig-bias", processing.rig_bias,
                  "Disparity error of the rig to be subtracted: rig_bias.json of an inspected recording")
      ->type_name("FILE");
}

PipelineOptions make_options(const ProcessingSettings& processing) {
  PipelineOptions options = preset(processing.preset);
  options.engine = processing.engine;
  options.threads = processing.threads;
  set_option(options, "perspective.scope", processing.scope);
  apply_settings(processing.settings, options);
  options.damage.severity = io::read_severity_scheme(processing.severity);
  if (!processing.rig_bias.empty()) options.rig_bias = io::read_rig_bias(processing.rig_bias);
  options.validate();
  return options;
}

bool sets_white_level(const ProcessingSettings& processing) {
  return std::any_of(processing.settings.begin(), processing.settings.end(),
                     [](const std::string& setting) { return split_setting(setting).first == "white_level"; });
}

}  // namespace roadstereo::cli
