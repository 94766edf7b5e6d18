#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadstereo::io {

/// A time of day, to the millisecond.
struct UtcTime {
  int year = 1970;
  int month = 1;        ///< 1 … 12
  int day = 1;          ///< 1 … 31
  int hour = 0;         ///< 0 … 23
  int minute = 0;       ///< 0 … 59
  int millisecond = 0;  ///< of the minute, 0 … 59999
};

/// The latest Unix time that is taken for one: the year 2100. Milliseconds since 1970 lie far above.
inline constexpr double latest_unix_s = 4102444800;

/// Nothing when the time is unknown, after the year 2100, or before 1980 and so rather a time since some start.
std::optional<UtcTime> utc_time(double unix_s);

/// ISO 8601: 2024-05-01T12:00:00.250Z.
std::string iso_text(const UtcTime& time);

/// What an ISO 8601 text says.
struct IsoTime {
  double unix_s = 0;      ///< taken for UTC where there is no zone
  bool has_zone = false;  ///< Z or an offset from UTC
};

/// Date and time of day, with "T" or a space between them: 2024-05-01T14:00:00.25+02:00. Nothing when it is none.
std::optional<IsoTime> parse_iso_time(std::string_view text);

}  // namespace roadstereo::io
