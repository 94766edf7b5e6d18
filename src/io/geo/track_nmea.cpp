#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>

#include "io/calibration_formats.hpp"
#include "io/geo/track_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Fields of a sentence without "$" and checksum; empty if the checksum is wrong or missing.
std::vector<std::string_view> fields_of(std::string_view line) {
  const std::size_t star = line.find('*');
  if (line.empty() || line.front() != '$' || star == std::string_view::npos || line.size() < star + 3) return {};
  const std::string_view body = line.substr(1, star - 1);
  unsigned sum = 0;
  for (const char letter : body) sum ^= static_cast<unsigned char>(letter);
  unsigned expected = 0;
  const char* digits = line.data() + star + 1;
  if (std::from_chars(digits, digits + 2, expected, 16).ptr != digits + 2 || expected != sum) return {};
  std::vector<std::string_view> fields;
  for (std::size_t from = 0; from <= body.size();) {
    const std::size_t end = std::min(body.find(',', from), body.size());
    fields.push_back(body.substr(from, end - from));
    from = end + 1;
  }
  return fields;
}

/// Degrees, up to `limit`, from "ddmm.mmm" and one of two letters of the compass.
double angle_of(const std::string& where, const char* name, std::string_view text, std::string_view side,
                std::string_view letters, double limit) {
  const double value = parse_number(where, name, text);
  const double degrees = std::floor(value / 100), minutes = value - 100 * degrees;
  const double angle = degrees + minutes / 60;
  if (!(value >= 0 && minutes < 60 && angle <= limit)) {
    fail(where, ": the ", name, " is ", text, "; it must be degrees and minutes up to ", limit, "°");
  }
  if (side.size() != 1 || letters.find(side) == std::string_view::npos) {
    fail(where, ": the side of the ", name, " is \"", side, "\"; it must be ", letters[0], " or ", letters[1]);
  }
  return side[0] == letters[1] ? -angle : angle;
}

/// Seconds of the day from "hhmmss.sss".
double second_of_day(const std::string& where, std::string_view text) {
  const double value = parse_number(where, "time", text);
  const double hours = std::floor(value / 10000);
  const double minutes = std::floor((value - 10000 * hours) / 100);
  const double seconds = value - 10000 * hours - 100 * minutes;
  if (!(hours >= 0 && hours < 24 && minutes < 60 && seconds < 61)) {
    fail(where, ": the time is ", text, "; it must be hhmmss");
  }
  return 3600 * hours + 60 * minutes + seconds;
}

/// Seconds from 1970 to the day "ddmmyy".
double day_s(const std::string& where, std::string_view text) {
  if (text.size() != 6 || text.find_first_not_of("0123456789") != std::string_view::npos) {
    fail(where, ": the date is ", text, "; it must be ddmmyy");
  }
  const auto number = static_cast<int>(parse_number(where, "date", text));
  const int year = number % 100;
  constexpr int first_year_of_gps = 80;
  const std::chrono::year_month_day date(std::chrono::year(year >= first_year_of_gps ? 1900 + year : 2000 + year),
                                         std::chrono::month(static_cast<unsigned>(number / 100 % 100)),
                                         std::chrono::day(static_cast<unsigned>(number / 10000)));
  if (!date.ok()) fail(where, ": the date is ", text, "; it must be ddmmyy");
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Altitude of a GGA sentence: above the ellipsoid where it tells the geoid, else above mean sea level.
struct Altitude {
  double second_of_day = -1;
  double metres = 0;
};

/// Reads sentence by sentence: positions, times and courses of RMC, altitudes of the GGA with the same time.
class NmeaReader {
 public:
  explicit NmeaReader(const std::string& path) : path_(path) {}

  void read(std::string_view line, std::size_t number) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.empty() || fields[0].size() != 5) return;
    const std::string where = name_line(path_, number);
    if (fields[0].ends_with("RMC") && fields.size() >= 10) read_rmc(where, fields, number);
    if (fields[0].ends_with("GGA") && fields.size() >= 10) read_gga(where, fields);
  }
  std::vector<TrackLine> points;

 private:
  void read_rmc(const std::string& where, const std::vector<std::string_view>& fields, std::size_t number) {
    if (fields[2] != "A") return;  // no fix
    TrackPoint point;
    last_second_ = second_of_day(where, fields[1]);
    point.time_s = day_s(where, fields[9]) + last_second_;
    point.lat_deg = angle_of(where, "latitude", fields[3], fields[4], "NS", 90);
    point.lon_deg = angle_of(where, "longitude", fields[5], fields[6], "EW", 180);
    constexpr double metres_per_second = 1852.0 / 3600;  // of a knot
    const bool moves =
        fields[7].empty() || parse_number(where, "speed", fields[7]) * metres_per_second >= min_course_m_s;
    point.heading_deg = parse_heading(where, "course", moves ? fields[8] : std::string_view());
    if (altitude_.second_of_day == last_second_) point.alt_m = altitude_.metres;
    points.push_back({point, number});
  }
  void read_gga(const std::string& where, const std::vector<std::string_view>& fields) {
    if (fields[1].empty() || fields[9].empty()) return;
    altitude_ = {second_of_day(where, fields[1]), parse_known(where, "altitude", fields[9])};
    const double geoid_m = fields.size() > 11 ? parse_known(where, "geoid separation", fields[11]) : std::nan("");
    if (std::isfinite(geoid_m)) altitude_.metres += geoid_m;
    if (!points.empty() && altitude_.second_of_day == last_second_) points.back().point.alt_m = altitude_.metres;
  }

  std::string path_;
  Altitude altitude_;
  double last_second_ = -2;  // of the day, of the last point
};

}  // namespace

std::vector<TrackLine> read_nmea(const TrackText& file) {
  NmeaReader reader(file.path);
  std::size_t number = 0;
  for (std::size_t from = 0; from < file.text.size();) {
    const std::size_t end = std::min(file.text.find('\n', from), file.text.size());
    reader.read(std::string_view(file.text).substr(from, end - from), ++number);
    from = end + 1;
  }
  if (reader.points.empty()) fail(file.path, ": there is no RMC sentence with a fix and a right checksum");
  return reader.points;
}

}  // namespace roadstereo::io
