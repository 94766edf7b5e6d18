#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace roadstereo::cli {

/// Returns a number, or null if it is not finite, which JSON cannot represent.
nlohmann::ordered_json json_number(double value);

/// Serialises a document; invalid UTF-8, e.g. of file names, is replaced.
std::string json_text(const nlohmann::ordered_json& document);

}  // namespace roadstereo::cli
