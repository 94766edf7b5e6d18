#pragma once

#include "inspection.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

/// Stages every file of one inspected pair but result.json. What a file cannot hold becomes a warning.
void add_result_files(Inspection& inspection, io::OutputFolder& folder);

}  // namespace roadstereo::cli
