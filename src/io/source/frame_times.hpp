#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

/// Parses a file name that is a time, seconds since 1970: 19, 16 or 13 digits (nano-, micro-, milliseconds, EuRoC) or
/// seconds with a decimal point. Returns nullopt for other names, e.g. frame numbers.
std::optional<double> time_of_name(const std::string& stem);

/// Throws Error naming `where` if a time, given as `text`, is no plausible number of seconds since 1970.
void require_seconds(const std::string& where, const std::string& text, double time_s);

/// Reads one time per line: seconds, or date and time of day (UTC, KITTI's timestamps.txt). Throws Error naming file
/// and line if one is neither, or if more than one lies before the one above.
std::vector<double> read_times(const std::filesystem::path& file);

}  // namespace roadstereo::io
