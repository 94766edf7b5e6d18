#include "roadstereo/io/severity_file.hpp"

#include <algorithm>
#include <array>

#include "io/file_bytes.hpp"
#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Value of one distress, named in error messages as "FILE: pothole".
struct Entry {
  std::string where;
  YAML::Node map;

  template <class Value>
  Value as(const YAML::Node& node, const char* key) const {
    try {
      return node.as<Value>();
    } catch (const YAML::Exception&) {
      if (!node) fail(where, ": ", key, " is missing");
      fail(where, ": ", key, " has the wrong value ", YAML::Dump(node));
    }
  }
};

Distress distress_of(const std::string& path, const std::string& name) {
  for (const Distress distress :
       {Distress::pothole, Distress::depression, Distress::rut, Distress::crack, Distress::bump, Distress::debris}) {
    if (name == name_of(distress)) return distress;
  }
  if (name == "kerb_step") return Distress::kerb_step;
  fail(path, ": \"", name, "\" is no distress; use pothole, depression, rut, crack, bump, debris, kerb_step");
}

Severity severity_of(const Entry& entry, const YAML::Node& node) {
  const auto name = entry.as<std::string>(node, "severity");
  for (const Severity severity : {Severity::low, Severity::medium, Severity::high}) {
    if (name == name_of(severity)) return severity;
  }
  fail(entry.where, ": severity has \"", name, "\"; it must be low, medium or high");
}

std::vector<double> metres_of(const Entry& entry, const char* key) {
  std::vector<double> metres;
  if (!entry.map[key]) return metres;
  for (const double mm : entry.as<std::vector<double>>(entry.map[key], key)) metres.push_back(mm / 1000);
  return metres;
}

DistressUnit unit_of(const Entry& entry) {
  const auto name = entry.as<std::string>(entry.map["unit"], "unit");
  for (const DistressUnit unit : {DistressUnit::count, DistressUnit::square_metre, DistressUnit::metre}) {
    if (name == name_of(unit)) return unit;
  }
  fail(entry.where, ": unit is \"", name, "\"; it must be count, m2 or m");
}

void require_known_keys(const Entry& entry) {
  constexpr std::array known{"unit", "depth_mm", "diameter_mm", "severity", "max_counted_mm", "area_of_one_m2"};
  for (const auto& item : entry.map) {
    const auto key = entry.as<std::string>(item.first, "a key");
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    fail(entry.where, ": \"", key,
         "\" is no key; use unit, depth_mm, diameter_mm, severity, max_counted_mm, area_of_one_m2");
  }
}

SeverityTable table_of(Distress distress, const Entry& entry) {
  require_known_keys(entry);
  SeverityTable table;
  table.distress = distress;
  table.unit = unit_of(entry);
  table.depths_m = metres_of(entry, "depth_mm");
  table.diameters_m = metres_of(entry, "diameter_mm");
  for (const YAML::Node& row : entry.map["severity"]) {
    std::vector<Severity>& classes = table.classes.emplace_back();
    if (row.IsScalar()) classes.push_back(severity_of(entry, row));
    for (const YAML::Node& cell : row) classes.push_back(severity_of(entry, cell));
  }
  if (entry.map["max_counted_mm"]) {
    table.max_counted_m = entry.as<double>(entry.map["max_counted_mm"], "max_counted_mm") / 1000;
  }
  if (entry.map["area_of_one_m2"]) {
    table.area_of_one_m2 = entry.as<double>(entry.map["area_of_one_m2"], "area_of_one_m2");
  }
  return table;
}

}  // namespace

SeverityScheme read_severity_scheme(const std::string& name) {
  if (name == "d6433") return astm_d6433();
  constexpr std::size_t max_bytes = 1U << 20U;
  const std::vector<std::uint8_t> bytes = read_file(name, max_bytes);
  const YAML::Node root = load_yaml({name, {bytes.begin(), bytes.end()}});
  SeverityScheme scheme{name, {}};
  for (const auto& item : root) {
    const Entry file{name, root};
    const auto key = file.as<std::string>(item.first, "a key");
    if (key == "name") {
      scheme.name = file.as<std::string>(item.second, "name");
      continue;
    }
    const Distress distress = distress_of(name, key);
    if (!item.second.IsMap()) fail(name, ": ", key, " must be a map with unit, depth_mm and severity");
    scheme.tables.push_back(table_of(distress, {std::string(name).append(": ").append(key), item.second}));
  }
  try {
    scheme.validate();
  } catch (const Error& error) {
    fail(name, ": ", error.what());
  }
  return scheme;
}

}  // namespace roadstereo::io
