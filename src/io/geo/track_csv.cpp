#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <optional>
#include <span>
#include <system_error>

#include "io/calibration_formats.hpp"
#include "io/fixed_text.hpp"
#include "io/geo/track_formats.hpp"
#include "io/plain_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::array time_names = {"time", "timestamp", "time_s", "time_utc", "datetime", "utc"};
constexpr std::array lat_names = {"lat", "latitude", "lat_deg", "latitude_deg"};
constexpr std::array lon_names = {"lon", "lng", "long", "longitude", "lon_deg", "longitude_deg"};
constexpr std::array alt_names = {"alt", "altitude", "ele", "elevation", "alt_m", "altitude_msl_m"};
// PX4's vehicle_gps_position, as ulog2csv writes it: microseconds, 1e-7 degrees and millimetres, or degrees and metres.
constexpr const char* px4_time = "time_utc_usec";
constexpr std::array horizontal_sd_names = {"horizontal_sd_m", "h_acc", "eph"};
constexpr std::array vertical_sd_names = {"vertical_sd_m", "v_acc", "epv"};
constexpr std::array heading_names = {"heading", "yaw", "heading_deg"};
constexpr std::array course_names = {"course", "bearing"};
constexpr std::array speed_names = {"speed", "speed_m_s", "speed_mps"};  // metres per second

std::string_view bare(std::string_view cell) {
  return trimmed(trimmed(cell), "\"");
}

/// Splits a line; separators between quotes are part of a cell.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != separator || quoted) continue;
    cells.push_back(bare(line.substr(from, i - from)));
    from = i + 1;
  }
  cells.push_back(bare(line.substr(from)));
}

/// Returns the non-empty lines with their numbers.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  std::optional<std::string_view> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      if (line.find_first_not_of(" \t\r") != std::string_view::npos && line.front() != '#') return line;
    }
    return std::nullopt;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

struct Column {
  std::string name;  ///< as in the file
  std::size_t index = 0;
};

/// Indices of the columns.
struct Columns {
  Column time, lat, lon;
  std::optional<Column> alt, heading, course, speed, horizontal_sd, vertical_sd;
  std::size_t count = 0;
  bool px4 = false;  ///< units of PX4's vehicle_gps_position
};

std::optional<Column> find_column(const std::vector<std::string_view>& header, std::span<const char* const> names) {
  const auto same = [](std::string_view one, std::string_view other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                      [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
  };
  for (const char* name : names) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (same(header[i], name)) return Column{std::string(header[i]), i};
    }
  }
  return std::nullopt;
}

char separator_of(std::string_view header) {
  constexpr std::string_view separators = ",;\t";
  return *std::max_element(separators.begin(), separators.end(), [&](char one, char other) {
    return std::count(header.begin(), header.end(), one) < std::count(header.begin(), header.end(), other);
  });
}

Columns find_columns(const std::string& where, const std::vector<std::string_view>& header) {
  const auto needed = [&](std::span<const char* const> names) {
    std::optional<Column> column = find_column(header, names);
    if (!column) {
      fail(where, ": there is no column ", names.front(),
           "; a track is GPX, or CSV with the columns time, lat, lon and optionally alt, heading");
    }
    return *std::move(column);
  };
  const std::optional<Column> px4 = find_column(header, std::array{px4_time});
  Columns columns;
  columns.time = px4 ? *px4 : needed(time_names);
  columns.lat = needed(lat_names);
  columns.lon = needed(lon_names);
  columns.alt = find_column(header, alt_names);
  columns.heading = find_column(header, heading_names);
  columns.course = find_column(header, course_names);
  columns.speed = find_column(header, speed_names);
  columns.horizontal_sd = find_column(header, horizontal_sd_names);
  columns.vertical_sd = find_column(header, vertical_sd_names);
  columns.count = header.size();
  columns.px4 = px4.has_value();
  return columns;
}

/// NaN unless the receiver knows it.
double standard_error(const std::string& where, const std::optional<Column>& column,
                      const std::vector<std::string_view>& cells) {
  const double value = column ? parse_known(where, column->name, cells[column->index]) : 0;
  return value > 0 ? value : std::numeric_limits<double>::quiet_NaN();
}

/// A row of PX4's vehicle_gps_position. Integers are 1e-7 degrees and millimetres in the columns lat, lon, alt.
std::optional<TrackPoint> read_px4_row(const std::string& where, const Columns& columns,
                                       const std::vector<std::string_view>& cells) {
  const auto number = [&](const Column& column) { return parse_number(where, column.name, cells[column.index]); };
  const double microseconds = number(columns.time);
  if (microseconds == 0) return std::nullopt;  // no fix yet
  const bool whole = columns.lat.name == "lat";
  TrackPoint point;
  point.time_s = parse_any_time(where, columns.time.name, fixed_text(1e-6 * microseconds, 6));
  const double degrees = whole ? 1e-7 : 1;
  point.lat_deg = degrees * number(columns.lat);
  point.lon_deg = degrees * number(columns.lon);
  parse_latitude(where, columns.lat.name, fixed_text(point.lat_deg, 6));
  parse_longitude(where, columns.lon.name, fixed_text(point.lon_deg, 6));
  if (columns.alt) {
    point.alt_m = (whole ? 1e-3 : 1) * parse_known(where, columns.alt->name, cells[columns.alt->index]);
  }
  return point;
}

void add_standard_errors(const std::string& where, const Columns& columns, const std::vector<std::string_view>& cells,
                         TrackPoint& point) {
  point.horizontal_sd_m = standard_error(where, columns.horizontal_sd, cells);
  point.vertical_sd_m = standard_error(where, columns.vertical_sd, cells);
}

/// Whether the speed is known and too small for a course.
bool stands(const Columns& columns, const std::vector<std::string_view>& cells) {
  if (!columns.speed) return false;
  const std::string_view text = cells[columns.speed->index];
  double speed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  return error == std::errc() && end == text.data() + text.size() && speed < min_course_m_s;
}

/// NaN if unknown, as the course is of a receiver that stands.
double heading_of(const std::string& where, const Columns& columns, const std::vector<std::string_view>& cells) {
  const std::optional<Column>& column = columns.heading ? columns.heading : columns.course;
  if (!column) return std::numeric_limits<double>::quiet_NaN();
  if (!columns.heading && stands(columns, cells)) return std::numeric_limits<double>::quiet_NaN();
  return parse_heading(where, column->name, cells[column->index]);
}

/// Returns nullopt if the receiver had no fix.
std::optional<TrackPoint> read_row(const std::string& where, const Columns& columns,
                                   const std::vector<std::string_view>& cells) {
  if (cells.size() != columns.count) {
    fail(where, ": the line has ", cells.size(), " cells; the header line has ", columns.count);
  }
  if (columns.px4) {
    std::optional<TrackPoint> point = read_px4_row(where, columns, cells);
    if (point) add_standard_errors(where, columns, cells, *point);
    return point;
  }
  if (cells[columns.lat.index].empty() && cells[columns.lon.index].empty()) return std::nullopt;
  TrackPoint point;
  point.time_s = parse_any_time(where, columns.time.name, cells[columns.time.index]);
  point.lat_deg = parse_latitude(where, columns.lat.name, cells[columns.lat.index]);
  point.lon_deg = parse_longitude(where, columns.lon.name, cells[columns.lon.index]);
  if (columns.alt) point.alt_m = parse_known(where, columns.alt->name, cells[columns.alt->index]);
  point.heading_deg = heading_of(where, columns, cells);
  add_standard_errors(where, columns, cells, point);
  return point;
}

}  // namespace

std::vector<TrackLine> read_track_csv(const TrackText& file) {
  Lines lines(file.text);
  const std::optional<std::string_view> header = lines.next();
  if (!header) fail(file.path, ": the file has no header line; a track is GPX, or CSV with time, lat, lon");
  const char separator = separator_of(*header);
  std::vector<std::string_view> cells;
  split_cells(*header, separator, cells);
  const Columns columns = find_columns(name_line(file.path, lines.number()), cells);
  std::vector<TrackLine> points;
  while (const std::optional<std::string_view> line = lines.next()) {
    split_cells(*line, separator, cells);
    const std::optional<TrackPoint> point = read_row(name_line(file.path, lines.number()), columns, cells);
    if (point) points.push_back({*point, lines.number()});
  }
  return points;
}

}  // namespace roadstereo::io
