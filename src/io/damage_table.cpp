#include "roadstereo/io/damage_table.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/damage_columns.hpp"
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

/// A value as a cell of CSV: the shortest digits that are read back as the same number. Texts are names of kinds and
/// severities, which need no quotes.
struct ToCell {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(double value) const {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
  }
};

Json damage_json(const Damage& damage) {
  Json row = Json::object();
  for (const DamageColumn& column : damage_columns()) row[column.name] = std::visit(ToJson{}, column.value(damage));
  return row;
}

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

std::string damages_json(const DamageMap& map) {
  Json document = {{"version", version}, {"metric", map.metric}};
  document["unmetric_reason"] = map.metric ? Json(nullptr) : Json(map.unmetric_reason);
  document["size"] = {{"width", map.ids.width()}, {"height", map.ids.height()}};
  document["noise_px"] = finite(map.noise_px);
  document["damages"] = Json::array();
  for (const Damage& damage : map.damages) document["damages"].push_back(damage_json(damage));
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string damages_csv(const DamageMap& map) {
  std::string text;
  const auto end_line = [&text] {
    text.back() = '\r';  // in the place of the last comma
    text += '\n';
  };
  for (const DamageColumn& column : damage_columns()) text += std::string(column.name) + ",";
  end_line();
  for (const Damage& damage : map.damages) {
    for (const DamageColumn& column : damage_columns()) text += std::visit(ToCell{}, column.value(damage)) + ",";
    end_line();
  }
  return text;
}

}  // namespace roadstereo::io
