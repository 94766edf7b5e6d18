#pragma once

#include <yaml-cpp/yaml.h>

#include <vector>

#include "io/calibration_formats.hpp"

namespace roadstereo::io {

/// The map at the top of a YAML file. Throws Error naming the file and the line.
YAML::Node load_yaml(const CalibrationText& file);

/// The figure under `key`. Throws Error when it is missing or no finite number.
double yaml_figure(const CalibrationText& file, const YAML::Node& map, const std::string& key);

/// The image side under `key`, 0 when the file does not say.
int yaml_side(const CalibrationText& file, const YAML::Node& map, const std::string& key);

/// The figures of the list `node`, called `key` in messages.
std::vector<double> yaml_figures(const CalibrationText& file, const YAML::Node& node, const std::string& key);

}  // namespace roadstereo::io
