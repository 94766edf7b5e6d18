#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

/// The time that a file name of a recording tells, seconds since 1970: 19, 16 or 13 digits (nano-, micro-,
/// milliseconds, as EuRoC has them) or seconds with a decimal point. Nothing for other names: a number is no time.
std::optional<double> time_of_name(const std::string& stem);

/// One time a line: seconds, or a date and time of day (UTC) as KITTI's timestamps.txt has them. Throws Error naming
/// file and line when one is neither, and when there are not `count` of them.
std::vector<double> read_times(const std::filesystem::path& file, std::size_t count);

}  // namespace roadstereo::io
