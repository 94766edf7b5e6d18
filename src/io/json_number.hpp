#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace roadstereo::io {

/// Returns a number, or null if it is not finite, which JSON cannot represent.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace roadstereo::io
