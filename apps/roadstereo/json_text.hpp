#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/json_number.hpp"

namespace roadstereo::cli {

using io::json_number;

/// Serialises a document; invalid UTF-8, e.g. of file names, is replaced.
std::string json_text(const nlohmann::ordered_json& document);

}  // namespace roadstereo::cli
