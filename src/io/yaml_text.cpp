#include "io/yaml_text.hpp"

#include <yaml-cpp/eventhandler.h>

#include <set>
#include <sstream>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Refuses what yaml-cpp reads without a word: a key given twice, of which it takes the first, and nesting by which the
/// parser's recursion would grow.
class Structure final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override { begin_item(); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { begin_item(); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& value) override {
    if (begin_item() && !open_.back().keys.insert(value).second) {
      throw YAML::ParserException(mark, value + " is given twice");
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, false);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, true);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Container {
    bool is_map = false;
    bool at_key = false;  ///< the last item was one
    std::set<std::string> keys;
  };

  /// Whether the item is a key.
  bool begin_item() {
    if (open_.empty() || !open_.back().is_map) return false;
    return open_.back().at_key = !open_.back().at_key;
  }

  void open(const YAML::Mark& mark, bool is_map) {
    constexpr std::size_t max_depth = 16;
    begin_item();
    open_.push_back({is_map, false, {}});
    if (open_.size() > max_depth) throw YAML::ParserException(mark, "lists and maps nested too deeply");
  }

  std::vector<Container> open_;
};

void check_structure(const std::string& text) {
  std::istringstream stream(text);
  Structure structure;
  YAML::Parser(stream).HandleNextDocument(structure);
}

}  // namespace

YAML::Node load_yaml(const CalibrationText& file) {
  YAML::Node root;
  try {
    check_structure(file.text);
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
