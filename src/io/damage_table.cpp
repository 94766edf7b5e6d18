#include "roadstereo/io/damage_table.hpp"

#include <nlohmann/json.hpp>

#include "io/csv.hpp"
#include "io/damage_columns.hpp"
#include "io/json_number.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::io {
namespace {

using Json = nlohmann::ordered_json;

struct ToJson {
  Json operator()(std::monostate) const { return nullptr; }
  template <class Value>
  Json operator()(const Value& value) const {
    return value;
  }
};

Json damage_json(const Damage& damage) {
  Json row = Json::object();
  for (const DamageColumn& column : damage_columns()) row[column.name] = std::visit(ToJson{}, column.value(damage));
  return row;
}

}  // namespace

std::string damages_json(const DamageMap& map) {
  Json document = {{"version", version}, {"metric", map.metric}};
  document["non_metric_reason"] = map.metric ? Json(nullptr) : Json(map.non_metric_reason);
  document["size"] = {{"width", map.ids.width()}, {"height", map.ids.height()}};
  document["noise_px"] = json_number(map.noise_px);
  document["damages"] = Json::array();
  for (const Damage& damage : map.damages) document["damages"].push_back(damage_json(damage));
  document["candidates"] = Json::array();
  for (const Damage& candidate : map.candidates) document["candidates"].push_back(damage_json(candidate));
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string damages_csv(const DamageMap& map) {
  CsvLine names;
  add_damage_names(names);
  std::string text = names.end();
  for (const Damage& damage : map.damages) {
    CsvLine line;
    add_damage_cells(damage, line);
    text += line.end();
  }
  return text;
}

}  // namespace roadstereo::io
