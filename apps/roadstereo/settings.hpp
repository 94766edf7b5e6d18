#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// The key and the value of one `--set KEY=VALUE`. Throws Error when it is not of that form.
std::pair<std::string, std::string> split_setting(const std::string& setting);

/// Sets one option after the other.
void apply_settings(const std::vector<std::string>& settings, PipelineOptions& options);

}  // namespace roadstereo::cli
