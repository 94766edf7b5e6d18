#pragma once

#include <optional>
#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Date and time of day in UTC with milliseconds.
struct UtcTime {
  int year = 1970;
  int month = 1;        ///< 1 … 12
  int day = 1;          ///< 1 … 31
  int hour = 0;         ///< 0 … 23
  int minute = 0;       ///< 0 … 59
  int millisecond = 0;  ///< in the minute, 0 … 59999
};

/// Maximum Unix time: the year 2100. Excludes milliseconds since 1970.
inline constexpr double latest_unix_s = 4102444800;

/// Converts Unix seconds. Returns nullopt for NaN, after 2100, and before 1980 (then a time since some start).
std::optional<UtcTime> utc_time(double unix_s);

/// Formats as ISO 8601: 2024-05-01T12:00:00.250Z.
std::string iso_text(const UtcTime& time);

/// A parsed ISO 8601 text.
struct IsoTime {
  double unix_s = 0;      ///< UTC if there is no zone
  bool has_zone = false;  ///< Z or an offset from UTC
};

/// Parses date and time of day with "T" or a space between them: 2024-05-01T14:00:00.25+02:00. Returns nullopt on
/// error.
std::optional<IsoTime> parse_iso_time(std::string_view text);

}  // namespace roadstereo::io
#pragma GCC visibility pop
