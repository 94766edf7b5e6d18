#include "io/yaml_text.hpp"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Limits the nesting of a file, by which the parser's recursion would grow.
class DepthLimit final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void enter(const YAML::Mark& mark) {
    constexpr int max_depth = 16;
    if (++depth_ > max_depth) throw YAML::ParserException(mark, "lists and maps nested too deeply");
  }

  int depth_ = 0;
};

void check_depth(const std::string& text) {
  std::istringstream stream(text);
  DepthLimit limit;
  YAML::Parser(stream).HandleNextDocument(limit);
}

}  // namespace

YAML::Node load_yaml(const CalibrationText& file) {
  YAML::Node root;
  try {
    check_depth(file.text);
    root = YAML::Load(file.text);
  } catch (const YAML::Exception& error) {
    fail(file.path, ": line ", error.mark.line + 1, ": invalid YAML: ", error.msg);
  }
  if (!root.IsMap()) fail(file.path, ": the file must consist of \"key: value\" lines");
  return root;
}

double yaml_number(const CalibrationText& file, const YAML::Node& map, const std::string& key) {
  const YAML::Node node = map[key];
  if (!node) fail(file.path, ": ", key, " is missing");
  if (!node.IsScalar()) fail(file.path, ": ", key, " must be a number");
  return parse_number(file.path, key, node.Scalar());
}

int yaml_side(const CalibrationText& file, const YAML::Node& map, const std::string& key) {
  const YAML::Node node = map[key];
  if (!node) return 0;
  if (!node.IsScalar()) fail(file.path, ": ", key, " must be a number");
  return parse_side(file.path, key, node.Scalar());
}

std::vector<double> yaml_numbers(const CalibrationText& file, const YAML::Node& node, const std::string& key) {
  if (!node || node.IsNull()) fail(file.path, ": ", key, " is missing");
  if (!node.IsSequence()) fail(file.path, ": ", key, " must be a list of numbers");
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    if (!item.IsScalar()) fail(file.path, ": ", key, " must be a list of numbers");
    values.push_back(parse_number(file.path, key + "[" + std::to_string(values.size()) + "]", item.Scalar()));
  }
  return values;
}

}  // namespace roadstereo::io
