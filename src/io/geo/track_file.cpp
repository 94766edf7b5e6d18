#include "io/file_bytes.hpp"
#include "io/geo/track_formats.hpp"
#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 28U;  // a day at 10 Hz is about 100 MB of GPX

std::vector<TrackLine> read_lines(const TrackText& file) {
  const std::size_t first = file.text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return read_track_csv(file);
  const std::string_view text = std::string_view(file.text).substr(first);
  if (text.front() == '<') return read_gpx(file);
  if (text.front() == '$') return read_nmea(file);
  constexpr std::size_t first_subtitle = 40;  // its number and its times
  if (text.substr(0, first_subtitle).find(" --> ") != std::string_view::npos) return read_srt(file);
  return read_track_csv(file);
}

/// What programs write before the first fix.
bool has_no_fix(const TrackPoint& point) {
  return point.lat_deg == 0 && point.lon_deg == 0;
}

void check_times(const std::string& path, const std::vector<TrackLine>& lines) {
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double step = lines[i].point.time_s - lines[i - 1].point.time_s;
    if (step < 0) {
      fail(name_line(path, lines[i].line), ": the time is ", -step, " s before that of line ", lines[i - 1].line,
           "; times must increase");
    }
  }
  if (lines.empty()) fail(path, ": the track has no points with a time; it must have at least two");
  if (lines.front().point.time_s == lines.back().point.time_s) {
    fail(path, ": the track has ", lines.size(), " point(s) at one time; it must have at least two times");
  }
}

}  // namespace

Track read_track(const std::string& path, const TrackOptions& options) {
  options.validate();
  constexpr const char* is_not = "neither a text file nor a bag; a track must be GPX, CSV, NMEA, DJI's SRT or a bag";
  std::vector<TrackLine> lines =
      is_message_log(path) ? read_track_bag(path) : read_lines({path, read_text(path, max_bytes, is_not)});
  std::erase_if(lines, [](const TrackLine& line) { return has_no_fix(line.point); });
  check_times(path, lines);
  std::vector<TrackPoint> points;
  points.reserve(lines.size());
  for (const TrackLine& line : lines) points.push_back(line.point);
  return Track(std::move(points), options);
}

}  // namespace roadstereo::io
