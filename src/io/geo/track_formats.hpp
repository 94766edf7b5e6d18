#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// A track's file as text.
struct TrackText {
  std::string path;
  std::string text;
};

/// A point and the line of the file that it comes from.
struct TrackLine {
  TrackPoint point;
  std::size_t line = 0;  ///< from 1
};

// One reader per format. Points are in the order of the file, and each is within its limits. Each throws Error naming
// the file, the line and the value.
std::vector<TrackLine> read_gpx(const TrackText& file);
std::vector<TrackLine> read_track_csv(const TrackText& file);

/// "FILE: line N", with which a sentence about a value begins.
std::string name_line(const std::string& path, std::size_t line);

// Values of a file in their limits. `where` begins the sentence of the Error, `name` is the value's name in the file.
double parse_latitude(const std::string& where, const std::string& name, std::string_view text);
double parse_longitude(const std::string& where, const std::string& name, std::string_view text);
/// NaN where the text is empty or "nan".
double parse_altitude(const std::string& where, const std::string& name, std::string_view text);
/// NaN where the text is empty or "nan".
double parse_heading(const std::string& where, const std::string& name, std::string_view text);
/// ISO 8601; one without a zone is UTC if that is the format's rule, else refused.
double parse_date_time(const std::string& where, const std::string& name, std::string_view text, bool is_utc);
/// Unix seconds, or ISO 8601 with a zone.
double parse_any_time(const std::string& where, const std::string& name, std::string_view text);

}  // namespace roadstereo::io
