#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// Slower than this a receiver's course over ground is noise, metres per second.
inline constexpr double min_course_m_s = 0.5;

/// A track file as text.
struct TrackText {
  std::string path;
  std::string text;
};

/// A point and its line in the file.
struct TrackLine {
  TrackPoint point;
  std::size_t line = 0;  ///< from 1
};

// One reader per format. Points are in the order of the file; every value is checked. Each throws Error naming the
// file, the line and the value.
std::vector<TrackLine> read_gpx(const TrackText& file);
std::vector<TrackLine> read_track_csv(const TrackText& file);
/// NMEA 0183: RMC and GGA sentences; those with a wrong checksum are left out.
std::vector<TrackLine> read_nmea(const TrackText& file);
/// Subtitles of a DJI drone. Times are those of the subtitles, since the start of the video.
std::vector<TrackLine> read_srt(const TrackText& file);
/// NavSatFix messages of a bag; `line` is the number of the message.
std::vector<TrackLine> read_track_bag(const std::string& path);

/// Returns "FILE: line N", the start of an error message.
std::string name_line(const std::string& path, std::size_t line);

// Parse values and check their limits. `where` starts the error message, `name` is the name of the value in the file.
double parse_latitude(const std::string& where, const std::string& name, std::string_view text);
double parse_longitude(const std::string& where, const std::string& name, std::string_view text);
/// Returns NaN if the text is empty or "nan".
double parse_known(const std::string& where, const std::string& name, std::string_view text);
/// Returns NaN if the text is empty or "nan".
double parse_heading(const std::string& where, const std::string& name, std::string_view text);
/// Parses ISO 8601. Text without a zone is UTC if `is_utc`, else an error.
double parse_date_time(const std::string& where, const std::string& name, std::string_view text, bool is_utc);
/// Parses Unix seconds, or ISO 8601 with a zone.
double parse_any_time(const std::string& where, const std::string& name, std::string_view text);

}  // namespace roadstereo::io
