#include <cctype>
#include <cmath>
#include <limits>

#include "io/calibration_formats.hpp"
#include "io/geo/track_formats.hpp"
#include "io/geo/utc_time.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

double parse_angle(const std::string& where, const std::string& name, std::string_view text, double max_deg) {
  const double value = parse_number(where, name, text);
  if (std::abs(value) > max_deg) {
    fail(where, ": ", name, " is ", value, "; it must be between ", -max_deg, " and ", max_deg, " degrees");
  }
  return value;
}

bool is_unknown(std::string_view text) {
  return text.empty() || text == "nan" || text == "NaN" || text == "NAN";
}

double in_time(const std::string& where, const std::string& name, double unix_s) {
  if (unix_s >= 0 && unix_s <= latest_unix_s) return unix_s;
  fail(where, ": ", name, " is ", unix_s, " seconds since 1970; it must be between 0 and ", latest_unix_s,
       " (the year 2100)");
}

}  // namespace

std::string name_line(const std::string& path, std::size_t line) {
  return path + ": line " + std::to_string(line);
}

double parse_latitude(const std::string& where, const std::string& name, std::string_view text) {
  return parse_angle(where, name, text, 90);
}

double parse_longitude(const std::string& where, const std::string& name, std::string_view text) {
  return parse_angle(where, name, text, 180);
}

double parse_known(const std::string& where, const std::string& name, std::string_view text) {
  if (is_unknown(text)) return std::numeric_limits<double>::quiet_NaN();
  return parse_number(where, name, text);
}

double parse_heading(const std::string& where, const std::string& name, std::string_view text) {
  if (is_unknown(text)) return std::numeric_limits<double>::quiet_NaN();
  return parse_angle(where, name, text, 360);
}

double parse_date_time(const std::string& where, const std::string& name, std::string_view text, bool is_utc) {
  const std::optional<IsoTime> time = parse_iso_time(text);
  if (!time) fail(where, ": ", name, " is \"", text.substr(0, 40), "\"; it must be like 2024-05-01T12:00:00.25Z");
  if (!time->has_zone && !is_utc) {
    fail(where, ": ", name, " is \"", text, "\", without a zone; it must end with Z or an offset from UTC (+02:00)");
  }
  return in_time(where, name, time->unix_s);
}

double parse_any_time(const std::string& where, const std::string& name, std::string_view text) {
  if (parse_iso_time(text)) return parse_date_time(where, name, text, false);
  const bool number = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
  const bool one_sign = number && text.find('-', 1) == std::string_view::npos;
  if (!one_sign) {
    fail(where, ": ", name, " is \"", text.substr(0, 40),
         "\"; it must be Unix seconds, or a date and time with a zone like 2024-05-01T12:00:00.25Z");
  }
  return in_time(where, name, parse_number(where, name, text));
}

}  // namespace roadstereo::io
