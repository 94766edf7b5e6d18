#pragma once

#include <string>

#include "inspection.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {

/// The content of result.json. What is not known is null.
std::string result_json(const Inspection& inspection);

/// Every option by its name.
nlohmann::ordered_json options_json(const PipelineOptions& options);

}  // namespace roadstereo::cli
