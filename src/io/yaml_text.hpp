#pragma once

#include <yaml-cpp/yaml.h>

#include <vector>

#include "io/calibration_formats.hpp"

namespace roadstereo::io {

/// Parses a YAML file whose top level is a map. Throws Error naming the file and the line, also of a key given twice.
YAML::Node load_yaml(const CalibrationText& file);

/// Returns the number under `key`. Throws Error if it is missing or not finite.
double yaml_number(const CalibrationText& file, const YAML::Node& map, const std::string& key);

/// Returns the image side under `key`; 0 if it is missing.
int yaml_side(const CalibrationText& file, const YAML::Node& map, const std::string& key);

/// Returns the numbers of the list `node`, named `key` in error messages.
std::vector<double> yaml_numbers(const CalibrationText& file, const YAML::Node& node, const std::string& key);

}  // namespace roadstereo::io
