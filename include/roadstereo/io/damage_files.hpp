#pragma once

#include "roadstereo/io/damage_report.hpp"
#include "roadstereo/io/output_folder.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Adds the damage results of one frame: damages.json, damages.csv, damage.png (16-bit grey, ids), overlay.png and
/// report.html. Throws Error if the sizes of the maps and the image differ.
void add_damage_files(OutputFolder& folder, const DamageReportInput& input);

}  // namespace roadstereo::io
#pragma GCC visibility pop
