#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "flight/flight_settings.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// Returns all inputs and options that determine the results of a flight, including a hash of its calibration.
/// Throws Error naming a calibration that cannot be read.
io::Provenance provenance(const FlightSettings& settings, const PipelineOptions& options);

/// Returns the FNV-1a hash of bytes as 16 hexadecimal digits.
std::string digest(std::string_view bytes);

/// Returns the hash of files, one after another. Throws Error naming a file that
/// cannot be read.
std::string content_digest(const std::vector<std::string>& files);

}  // namespace roadstereo::cli
