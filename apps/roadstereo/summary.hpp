#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "inspection.hpp"
#include "roadstereo/io/damage_report.hpp"

namespace roadstereo::cli {

/// Returns the terminal output for one inspected pair.
std::string summary(const Inspection& inspection, const std::filesystem::path& folder);

/// Returns what the pair tells of a road without damage.
io::InspectionLimits limits_of(const Inspection& inspection);

/// Describes the damage in one line.
std::string damage_text(const DamageMap& map, const io::InspectionLimits& limits);

/// Returns the summary as names and values for the report.
std::vector<std::pair<std::string, std::string>> summary_properties(const Inspection& inspection);

}  // namespace roadstereo::cli
