#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace roadstereo::cli {

/// A number, or null for what is not finite: JSON knows neither NaN nor infinity.
nlohmann::ordered_json json_number(double value);

/// The text of a document; file names that are not UTF-8 are written with replacement characters.
std::string json_text(const nlohmann::ordered_json& document);

}  // namespace roadstereo::cli
