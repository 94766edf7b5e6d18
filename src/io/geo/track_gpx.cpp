#include <algorithm>
#include <array>
#include <pugixml.hpp>

#include "io/calibration_formats.hpp"
#include "io/geo/track_formats.hpp"
#include "io/plain_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Removes the namespace prefix of a name.
std::string_view local_name(std::string_view name) {
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

bool is_called(const pugi::xml_node& node, std::string_view name) {
  return local_name(node.name()) == name;
}

pugi::xml_node child_called(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([name](const pugi::xml_node& child) { return is_called(child, name); });
}

std::string_view text_of(const pugi::xml_node& node) {
  return trimmed(node.child_value());
}

/// Finds the line numbers of ascending offsets.
class LineCount {
 public:
  explicit LineCount(std::string_view text) : text_(text) {}

  std::size_t line_at(std::ptrdiff_t offset) {
    const std::size_t to = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), text_.size());
    for (; at_ < to; ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

std::string_view attribute(const std::string& where, const pugi::xml_node& node, const char* name) {
  const pugi::xml_attribute found = node.attribute(name);
  if (!found) fail(where, ": this ", node.name(), " has no ", name);
  return found.value();
}

/// The first node of that name in a point. GPX 1.0 has <course> and <speed> in the point; in 1.1 they are in vendor
/// extensions.
pugi::xml_node find_in(const pugi::xml_node& point, const char* name) {
  return point.find_node([name](const pugi::xml_node& each) { return is_called(each, name); });
}

double heading_of(const std::string& where, const pugi::xml_node& node) {
  for (const char* name : {"heading", "yaw"}) {
    if (const pugi::xml_node found = find_in(node, name)) return parse_heading(where, name, text_of(found));
  }
  const std::string_view speed = text_of(find_in(node, "speed"));
  const bool moves = speed.empty() || parse_number(where, "speed", speed) >= min_course_m_s;
  return parse_heading(where, "course", moves ? text_of(find_in(node, "course")) : std::string_view());
}

TrackLine read_point(const std::string& path, const pugi::xml_node& node, LineCount& lines) {
  TrackLine read;
  read.line = lines.line_at(node.offset_debug());
  const std::string where = name_line(path, read.line);
  read.point.lat_deg = parse_latitude(where, "lat", attribute(where, node, "lat"));
  read.point.lon_deg = parse_longitude(where, "lon", attribute(where, node, "lon"));
  const pugi::xml_node time = child_called(node, "time");
  if (!time) fail(where, ": this trkpt has no <time>");
  read.point.time_s = parse_date_time(where, "time", text_of(time), true);
  read.point.alt_m = parse_known(where, "ele", text_of(child_called(node, "ele")));
  read.point.heading_deg = heading_of(where, node);
  return read;
}

pugi::xml_document parse(const TrackText& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(file.text.data(), file.text.size());
  if (!result) {
    fail(name_line(file.path, LineCount(file.text).line_at(result.offset)), ": invalid XML: ", result.description());
  }
  return document;
}

}  // namespace

std::vector<TrackLine> read_gpx(const TrackText& file) {
  const pugi::xml_document document = parse(file);
  const pugi::xml_node root = document.document_element();
  if (!is_called(root, "gpx")) fail(file.path, ": the root element is <", root.name(), ">; a track must be GPX or CSV");
  LineCount lines(file.text);
  std::vector<std::vector<TrackLine>> segments;
  for (const pugi::xml_node& track : root.children()) {
    if (!is_called(track, "trk")) continue;
    for (const pugi::xml_node& segment : track.children()) {
      if (!is_called(segment, "trkseg")) continue;
      std::vector<TrackLine> points;
      for (const pugi::xml_node& node : segment.children()) {
        if (is_called(node, "trkpt")) points.push_back(read_point(file.path, node, lines));
      }
      if (!points.empty()) segments.push_back(std::move(points));
    }
  }
  std::stable_sort(segments.begin(), segments.end(), [](const auto& one, const auto& other) {
    return one.front().point.time_s < other.front().point.time_s;
  });
  std::vector<TrackLine> all;
  for (const std::vector<TrackLine>& segment : segments) all.insert(all.end(), segment.begin(), segment.end());
  return all;
}

}  // namespace roadstereo::io
