#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "io/calibration_formats.hpp"
#include "io/geo/track_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Seconds of "00:01:02,345" at the start of a line of subtitles; NaN for other lines.
double cue_start_s(const std::string& where, std::string_view line) {
  constexpr std::size_t time_letters = 12;
  if (line.find(" --> ") != time_letters) return nan;
  const auto number = [&](std::size_t from, std::size_t count) {
    return parse_number(where, "time", line.substr(from, count));
  };
  return 3600 * number(0, 2) + 60 * number(3, 2) + number(6, 2) + 1e-3 * number(9, 3);
}

/// The number after the name and a colon, as in "[latitude: 48.1]"; empty if the line has no such name.
std::string_view value_after(std::string_view line, std::string_view name) {
  std::size_t at = line.find(name);
  while (at != std::string_view::npos && at > 0 && std::isalpha(static_cast<unsigned char>(line[at - 1])) != 0) {
    at = line.find(name, at + 1);
  }
  if (at == std::string_view::npos) return {};
  at = line.find_first_not_of(" :", at + name.size());
  if (at == std::string_view::npos) return {};
  return line.substr(at, line.find_first_not_of("+-.0123456789eE", at) - at);
}

std::string_view first_of(std::string_view line, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const std::string_view value = value_after(line, name);
    if (!value.empty()) return value;
  }
  return {};
}

/// Older drones: "GPS(11.58,48.14,19)", longitude first; the third number is that of the satellites.
bool read_gps(const std::string& where, std::string_view line, TrackPoint& point) {
  constexpr std::string_view name = "GPS(";
  const std::size_t at = line.find(name);
  const std::size_t comma = line.find(',', at);
  if (at == std::string_view::npos || comma == std::string_view::npos) return false;
  const std::size_t end = line.find_first_of(",)", comma + 1);
  if (end == std::string_view::npos) return false;
  const std::size_t first = at + name.size();
  point.lon_deg = parse_longitude(where, "GPS", line.substr(first, comma - first));
  const std::size_t second = line.find_first_not_of(' ', comma + 1);
  point.lat_deg = parse_latitude(where, "GPS", line.substr(second, end - second));
  point.alt_m = parse_known(where, "BAROMETER", value_after(line, "BAROMETER"));
  return true;
}

bool read_position(const std::string& where, std::string_view line, TrackPoint& point) {
  const std::string_view lat = value_after(line, "latitude");
  const std::string_view lon = first_of(line, {"longitude", "longtitude"});  // DJI misspells it
  if (lat.empty() || lon.empty()) return read_gps(where, line, point);
  point.lat_deg = parse_latitude(where, "latitude", lat);
  point.lon_deg = parse_longitude(where, "longitude", lon);
  point.alt_m = parse_known(where, "altitude", first_of(line, {"abs_alt", "altitude"}));
  return true;
}

}  // namespace

std::vector<TrackLine> read_srt(const TrackText& file) {
  std::vector<TrackLine> points;
  double start_s = nan;
  std::size_t number = 0;
  for (std::size_t from = 0; from < file.text.size();) {
    const std::size_t end = std::min(file.text.find('\n', from), file.text.size());
    const std::string_view line = std::string_view(file.text).substr(from, end - from);
    from = end + 1;
    const std::string where = name_line(file.path, ++number);
    if (const double cue = cue_start_s(where, line); !std::isnan(cue)) {
      start_s = cue;
      continue;
    }
    TrackPoint point;
    if (std::isnan(start_s) || !read_position(where, line, point)) continue;
    point.time_s = start_s;
    points.push_back({point, number});
    start_s = nan;  // one position per subtitle
  }
  return points;
}

}  // namespace roadstereo::io
