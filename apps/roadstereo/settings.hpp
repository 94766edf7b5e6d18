#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Splits `KEY=VALUE` of --set. Throws Error if it is not of that form.
std::pair<std::string, std::string> split_setting(const std::string& setting);

/// Sets the options in order.
void apply_settings(const std::vector<std::string>& settings, PipelineOptions& options);

}  // namespace roadstereo::cli
