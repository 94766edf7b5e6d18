#include "io/report/list.hpp"

#include <vector>

#include "io/report/cells.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

using Cell = ReportCell;
using Column = ReportColumn<Damage>;

Cell id_cell(const Damage& damage) {
  const std::string id = std::to_string(damage.id);
  return {"<a href=\"#damage-" + id + "\">" + id + "</a>", static_cast<double>(damage.id)};
}

Cell kind_cell(const Damage& damage) {
  return {name_of(damage.kind)};
}

std::vector<Column> metric_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Kind", "", kind_cell},
          {"Severity", "", severity_cell},
          {"Confidence", "%", [](const D& d) { return fixed_cell(100 * d.confidence, 0); }},
          {"Max depth", "mm", [](const D& d) { return measured_cell(scaled(d.metrics->max_depth_m, mm)); }},
          {"Mean depth", "mm", [](const D& d) { return measured_cell(scaled(d.metrics->mean_depth_m, mm)); }},
          {"Area", "m²", [](const D& d) { return measured_cell(d.metrics->area_m2); }},
          {"Volume", "L", [](const D& d) { return measured_cell(scaled(d.metrics->volume_m3, litres)); }},
          {"Length", "m", [](const D& d) { return plain_cell(d.metrics->length_m); }},
          {"Width", "m", [](const D& d) { return plain_cell(d.metrics->width_m); }},
          {"Diameter", "m", [](const D& d) { return plain_cell(d.metrics->diameter_m); }},
          {"Road x", "m", [](const D& d) { return fixed_cell(d.metrics->road_centroid_m[0], 2); }},
          {"Road y", "m", [](const D& d) { return fixed_cell(d.metrics->road_centroid_m[1], 2); }},
          {"Distance", "m", [](const D& d) { return fixed_cell(d.metrics->distance_m, 2); }},
          {"Resolvable", "mm", [](const D& d) { return plain_cell(d.metrics->resolvable_depth_m * mm); }},
          {"Measured", "%", [](const D& d) { return fixed_cell(100 * d.measured_share, 0); }}};
}

std::vector<Column> pixel_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Kind", "", kind_cell},
          {"Confidence", "%", [](const D& d) { return fixed_cell(100 * d.confidence, 0); }},
          {"Max change", "px", [](const D& d) { return measured_cell(d.max_depth_px); }},
          {"Mean change", "px", [](const D& d) { return plain_cell(d.mean_depth_px); }},
          {"Size", "px", [](const D& d) { return fixed_cell(static_cast<double>(d.pixels), 0); }},
          {"Centre u", "px", [](const D& d) { return fixed_cell(d.centroid_px[0], 0); }},
          {"Centre v", "px", [](const D& d) { return fixed_cell(d.centroid_px[1], 0); }},
          {"Measured", "%", [](const D& d) { return fixed_cell(100 * d.measured_share, 0); }}};
}

bool all_metric(const DamageMap& map) {
  for (const Damage& damage : map.damages) {
    if (!damage.metrics) return false;
  }
  return true;
}

}  // namespace

std::string damage_list(const DamageMap& map) {
  if (map.damages.empty()) return "";
  const std::vector<Column> columns = all_metric(map) ? metric_columns() : pixel_columns();
  return fill(templates::table, {{"id", "list"},
                                 {"title", "All damages"},
                                 {"hint", std::string(sorting_hint) + " ± is one standard error."},
                                 {"headings", report_headings(columns)},
                                 {"rows", report_rows(columns, map.damages)}});
}

}  // namespace roadstereo::io
