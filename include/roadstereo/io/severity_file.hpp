#pragma once

#include <string>

#include "roadstereo/severity.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Reads tables of severities: "d6433", or a YAML file with `name` and one map per distress (pothole, depression, rut,
/// crack, bump, debris, kerb_step):
///   unit: count, m2 or m
///   depth_mm: lower limits of the rows, ascending; without it the distress is counted but not graded
///   diameter_mm: lower limits of the columns, ascending; may be missing
///   severity: one class (low, medium, high) per row, or a list per row with one class per column
///   max_counted_mm, area_of_one_m2: wider damages count by their area; may be missing
/// Throws Error naming the file, the distress and the value.
SeverityScheme read_severity_scheme(const std::string& name);

}  // namespace roadstereo::io
#pragma GCC visibility pop
