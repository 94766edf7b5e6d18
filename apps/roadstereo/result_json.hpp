#pragma once

#include <string>

#include "inspection.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {

/// Returns the content of result.json. Unknown values are null.
std::string result_json(const Inspection& inspection);

/// Returns all options by name.
nlohmann::ordered_json options_json(const PipelineOptions& options);

}  // namespace roadstereo::cli
