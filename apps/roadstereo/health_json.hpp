#pragma once

#include <nlohmann/json.hpp>

#include "roadstereo/health.hpp"

namespace roadstereo::cli {

/// Return the findings, each with its id, value, limit, unit and text.
nlohmann::ordered_json findings_json(const std::vector<HealthFinding>& findings);

/// Return every measured number (null unknown), the findings, and whether the depth can be trusted.
nlohmann::ordered_json health_json(const PairHealth& health);

}  // namespace roadstereo::cli
