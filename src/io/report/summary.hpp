#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// Returns the summary cards: number of damages by severity, total area and volume.
std::string summary_cards(const DamageMap& map);

/// Returns a notice if there is no damage or no metric result, else "".
std::string summary_notices(const DamageMap& map);

/// Returns names and values as an HTML list.
std::string property_list(const std::vector<std::pair<std::string, std::string>>& properties);

/// Returns the legend of the severities.
std::string severity_legend();

/// Returns the severity colours as CSS custom properties.
std::string severity_colours();

}  // namespace roadstereo::io
