#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

/// Parses a file name that is a time, seconds since 1970: 19, 16 or 13 digits (nano-, micro-, milliseconds, EuRoC) or
/// seconds with a decimal point. Returns nullopt for other names, e.g. frame numbers.
std::optional<double> time_of_name(const std::string& stem);

/// Reads one time per line: seconds, or date and time of day (UTC, KITTI's timestamps.txt). Throws Error naming file
/// and line if one is neither, or if their number is not `count`; one may be missing at the end, that of a recording
/// which was killed while it wrote the last pair.
std::vector<double> read_times(const std::filesystem::path& file, std::size_t count);

}  // namespace roadstereo::io
