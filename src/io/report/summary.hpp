#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/io/damage_report.hpp"

namespace roadstereo::io {

/// Returns the summary cards: number of damages by distress and severity, total area and volume. The report tells of
/// the first `listed` damages, which links may lead to.
std::string damages_cards(const std::vector<Damage>& damages, std::size_t listed, std::size_t candidates, bool metric);

/// Returns the notice that no damage was found, `where`: "", or " in …"; candidates are pointed to. It praises the road
/// only where nothing of the pictures is `flawed`.
std::string no_damage_notice(const std::string& where, bool has_candidates, const InspectionLimits& limits,
                             bool flawed);

/// Returns the notices of a pair: whether there is damage, what is not metric, and the warnings.
std::string summary_notices(const DamageReportInput& input);

/// Returns names and values as an HTML list.
std::string property_list(const std::vector<std::pair<std::string, std::string>>& properties);

/// Returns the legend of the severities.
std::string severity_legend(const SeverityScheme& scheme);

/// Returns the severity colours as CSS custom properties.
std::string severity_colours();

}  // namespace roadstereo::io
