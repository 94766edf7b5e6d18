#include "io/opencv_file.hpp"

#include <algorithm>
#include <pugixml.hpp>

#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Kind = OpenCvEntry::Kind;

/// Returns the scalars of a list; no words if it has others.
OpenCvEntry entry_of_list(const YAML::Node& list, Kind kind) {
  OpenCvEntry entry;
  for (const YAML::Node& item : list) {
    if (!item.IsScalar()) return {};
    entry.words.push_back(item.Scalar());
  }
  entry.kind = kind;
  return entry;
}

std::string scalar_of(const YAML::Node& node) {
  return node && node.IsScalar() ? node.Scalar() : "";
}

OpenCvEntry entry_of(const YAML::Node& node) {
  if (node.IsScalar()) return {Kind::text, {node.Scalar()}, "", ""};
  if (node.IsSequence()) return entry_of_list(node, Kind::list);
  if (!node.IsMap() || !node["data"] || !node["data"].IsSequence()) return {};
  OpenCvEntry entry = entry_of_list(node["data"], Kind::matrix);
  entry.rows = scalar_of(node["rows"]);
  entry.cols = scalar_of(node["cols"]);
  return entry;
}

OpenCvEntries parse_yaml(CalibrationText file) {
  if (file.text.starts_with("%YAML")) file.text.erase(0, file.text.find('\n'));  // "%YAML:1.0" is no YAML directive
  OpenCvEntries entries;
  for (const auto& item : load_yaml(file)) {
    if (item.first.IsScalar()) entries[item.first.Scalar()] = entry_of(item.second);
  }
  return entries;
}

std::vector<std::string> words_of(const char* text) {
  const std::vector<std::string_view> words = split_words(text);
  return {words.begin(), words.end()};
}

OpenCvEntry entry_of(const pugi::xml_node& node) {
  if (node.child("data")) {
    return {Kind::matrix, words_of(node.child_value("data")), node.child_value("rows"), node.child_value("cols")};
  }
  OpenCvEntry entry{Kind::list, words_of(node.child_value()), "", ""};
  if (entry.words.empty()) entry.kind = Kind::other;
  if (entry.words.size() == 1) entry.kind = Kind::text;
  return entry;
}

OpenCvEntries parse_xml(const CalibrationText& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(file.text.data(), file.text.size());
  if (!parsed) fail(file.path, ": invalid XML at byte ", parsed.offset, ": ", parsed.description());
  OpenCvEntries entries;
  for (const pugi::xml_node& node : document.child("opencv_storage")) entries[node.name()] = entry_of(node);
  return entries;
}

}  // namespace

OpenCvEntries parse_opencv_file(const CalibrationText& file) {
  return file.text.starts_with("<") ? parse_xml(file) : parse_yaml(file);
}

}  // namespace roadstereo::io
