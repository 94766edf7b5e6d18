#pragma once

#include "inspection.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

/// Stages all files of one inspected pair except result.json. Values that a file cannot store yield a warning.
void add_result_files(Inspection& inspection, io::OutputFolder& folder);

}  // namespace roadstereo::cli
