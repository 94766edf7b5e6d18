#include "io/geo/layer_style.hpp"

#include <array>

#include "io/damage_colours.hpp"
#include "io/geo/templates.hpp"
#include "io/report/markup.hpp"

namespace roadstereo::io {
namespace {

constexpr std::array severities{Severity::high,      Severity::medium,       Severity::low,    Severity::minor,
                                Severity::uncertain, Severity::unresolvable, Severity::unknown};

constexpr Rgb not_graded{60, 130, 210};

std::string rgb_text(const Rgb& colour) {
  return std::to_string(colour[0]) + "," + std::to_string(colour[1]) + "," + std::to_string(colour[2]);
}

GeoColumn<LayerStyle> text_column(const char* name, std::string (*value)(const LayerStyle& style)) {
  return {name, GeoType::text, [value](const LayerStyle& style) { return GeoValue(value(style)); }};
}

}  // namespace

const std::vector<GeoColumn<LayerStyle>>& layer_style_columns() {
  using Style = LayerStyle;
  static const std::vector<GeoColumn<Style>> columns = {
      text_column("f_table_catalog", [](const Style&) { return std::string(); }),
      text_column("f_table_schema", [](const Style&) { return std::string(); }),
      text_column("f_table_name", [](const Style& style) { return style.layer; }),
      text_column("f_geometry_column", [](const Style&) { return std::string("geom"); }),
      text_column("styleName", [](const Style&) { return std::string("severity"); }),
      text_column("styleQML", [](const Style& style) { return style.qml; }),
      text_column("styleSLD", [](const Style&) { return std::string(); }),
      {"useAsDefault", GeoType::flag, [](const Style&) { return GeoValue(true); }},
      text_column("description", [](const Style&) { return std::string("Damage by severity"); }),
      text_column("owner", [](const Style&) { return std::string(); }),
      text_column("ui", [](const Style&) { return std::string(); }),
      {"update_time", GeoType::time, [](const Style&) { return GeoValue(UtcTime{}); }}};
  return columns;
}

LayerStyle severity_style(const std::string& layer) {
  std::string categories, symbols;
  for (std::size_t i = 0; i < severities.size(); ++i) {
    const std::string name = name_of(severities[i]);
    const Fields fields{
        {"index", std::to_string(i)},
        {"severity", name},
        {"label", severities[i] == Severity::unknown ? "not graded" : name},
        {"rgb", rgb_text(severities[i] == Severity::unknown ? not_graded  // potholes and bumps alike
                                                            : damage_colour(DamageKind::depression, severities[i]))}};
    categories += fill(geo_templates::category, fields);
    symbols += fill(geo_templates::symbol, fields);
  }
  return {layer, fill(geo_templates::style, {{"categories", categories}, {"symbols", symbols}})};
}

}  // namespace roadstereo::io
