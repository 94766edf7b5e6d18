#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "inspection.hpp"

namespace roadstereo::cli {

/// What the terminal shows of one inspected pair: one screen.
std::string summary(const Inspection& inspection, const std::filesystem::path& folder);

/// What was found, in one line.
std::string damage_text(const DamageMap& map);

/// The same figures as pairs of a name and a value, for the report.
std::vector<std::pair<std::string, std::string>> summary_facts(const Inspection& inspection);

}  // namespace roadstereo::cli
