#pragma once

#include "roadstereo/io/damage_report.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::io {

/// Adds what is known of a frame's damage: damages.json, damages.csv, damage.png (16-bit grey, ids), overlay.png and
/// report.html. Throws Error when the sizes of maps and image differ.
void add_damage_files(OutputFolder& folder, const DamageReportInput& input);

}  // namespace roadstereo::io
