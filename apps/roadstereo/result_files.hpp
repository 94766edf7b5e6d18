#pragma once

#include <string>
#include <vector>

#include "inspection.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

/// Words of --write for a pair: disparity, sigma, transformed, sheet, cloud, damages, overlay, report.
const std::vector<std::string>& result_words();

/// Stages the files of one inspected pair except result.json: those of the words, or all if there are none. Fills
/// `Inspection::files_written`. Values that a file cannot store yield a warning. Throws Error for an unknown word.
void add_result_files(const std::vector<std::string>& words, Inspection& inspection, io::OutputFolder& folder);

}  // namespace roadstereo::cli
