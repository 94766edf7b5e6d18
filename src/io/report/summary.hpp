#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// The figures at the head of a report: how many damages of which severity, how large altogether.
std::string summary_cards(const DamageMap& map);

/// A sentence when there is no damage, or no metres, else nothing.
std::string summary_notices(const DamageMap& map);

/// Key figures as a list of names and values.
std::string fact_list(const std::vector<std::pair<std::string, std::string>>& facts);

/// What the severities mean.
std::string severity_legend();

/// The colours of the severities as custom properties of a style sheet.
std::string severity_colours();

}  // namespace roadstereo::io
