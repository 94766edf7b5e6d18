#include "io/report/list.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/report/figures.hpp"
#include "io/report/markup.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

/// What a cell shows, and the number it is sorted by; without one it is sorted by its text.
struct Cell {
  std::string html;
  std::optional<double> key{};
};

struct Column {
  std::string title;
  std::string unit;
  Cell (*cell)(const Damage& damage);
};

Cell measured(const Measured& figure) {
  return {escaped(measured_text(figure, "")), figure.value};
}

Cell plain(double value) {
  return {escaped(value_text(value, "")), value};
}

Cell fixed(double value, int decimals) {
  return {number_text(value, decimals), value};
}

Cell id_cell(const Damage& damage) {
  const std::string id = std::to_string(damage.id);
  return {"<a href=\"#damage-" + id + "\">" + id + "</a>", static_cast<double>(damage.id)};
}

Cell kind_cell(const Damage& damage) {
  return {name_of(damage.kind)};
}

Cell severity_cell(const Damage& damage) {
  const std::string name = name_of(severity_of(damage));
  return {"<span class=\"chip " + name + " " + name_of(damage.kind) + "\">" + name + "</span>",
          static_cast<double>(severity_of(damage))};
}

std::vector<Column> metric_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Kind", "", kind_cell},
          {"Severity", "", severity_cell},
          {"Max depth", "mm", [](const D& d) { return measured(scaled(d.metrics->max_depth_m, mm)); }},
          {"Mean depth", "mm", [](const D& d) { return measured(scaled(d.metrics->mean_depth_m, mm)); }},
          {"Area", "m²", [](const D& d) { return measured(d.metrics->area_m2); }},
          {"Volume", "L", [](const D& d) { return measured(scaled(d.metrics->volume_m3, litres)); }},
          {"Length", "m", [](const D& d) { return plain(d.metrics->length_m); }},
          {"Width", "m", [](const D& d) { return plain(d.metrics->width_m); }},
          {"Diameter", "m", [](const D& d) { return plain(d.metrics->diameter_m); }},
          {"Road x", "m", [](const D& d) { return fixed(d.metrics->road_centroid_m[0], 2); }},
          {"Road y", "m", [](const D& d) { return fixed(d.metrics->road_centroid_m[1], 2); }},
          {"Distance", "m", [](const D& d) { return fixed(d.metrics->distance_m, 2); }},
          {"Resolvable", "mm", [](const D& d) { return plain(d.metrics->resolvable_depth_m * mm); }},
          {"Measured", "%", [](const D& d) { return fixed(100 * d.measured_share, 0); }}};
}

std::vector<Column> pixel_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Kind", "", kind_cell},
          {"Max change", "px", [](const D& d) { return measured(d.max_depth_px); }},
          {"Mean change", "px", [](const D& d) { return plain(d.mean_depth_px); }},
          {"Size", "px", [](const D& d) { return fixed(static_cast<double>(d.pixels), 0); }},
          {"Centre u", "px", [](const D& d) { return fixed(d.centroid_px[0], 0); }},
          {"Centre v", "px", [](const D& d) { return fixed(d.centroid_px[1], 0); }},
          {"Measured", "%", [](const D& d) { return fixed(100 * d.measured_share, 0); }}};
}

bool all_metric(const DamageMap& map) {
  for (const Damage& damage : map.damages) {
    if (!damage.metrics) return false;
  }
  return true;
}

/// The attribute that a cell is sorted by; empty for what is not known.
std::string key_attribute(const Cell& cell) {
  if (!cell.key) return "";
  if (!std::isfinite(*cell.key)) return " data-key=\"\"";
  std::array<char, 32> digits{};
  const auto* const end = std::to_chars(digits.data(), digits.data() + digits.size(), *cell.key).ptr;
  return " data-key=\"" + std::string(digits.data(), static_cast<std::size_t>(end - digits.data())) + "\"";
}

std::string heading(const Column& column) {
  const std::string unit = column.unit.empty() ? "" : " <small>" + escaped(column.unit) + "</small>";
  return "<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">" + escaped(column.title) + unit +
         "</button></th>";
}

std::string row(const std::vector<Column>& columns, const Damage& damage) {
  std::string html = "<tr>";
  for (const Column& column : columns) {
    const Cell cell = column.cell(damage);
    html += "<td" + key_attribute(cell) + ">" + cell.html + "</td>";
  }
  return html + "</tr>\n";
}

}  // namespace

std::string damage_list(const DamageMap& map) {
  if (map.damages.empty()) return "";
  const std::vector<Column> columns = all_metric(map) ? metric_columns() : pixel_columns();
  std::string headings, rows;
  for (const Column& column : columns) headings += heading(column);
  for (const Damage& damage : map.damages) rows += row(columns, damage);
  return fill(templates::table, {{"headings", headings}, {"rows", rows}});
}

}  // namespace roadstereo::io
