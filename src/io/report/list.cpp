#include "io/report/list.hpp"

#include <algorithm>
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
  return {damage_link(damage.id, std::to_string(damage.id)), static_cast<double>(damage.id)};
}

std::vector<Column> metric_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Distress", "", distress_cell},
          {"Severity", "", severity_cell},
          {"Depth", "mm", [](const D& d) { return measured_cell(scaled(d.metrics->max_depth_m, mm)); }},
          {"Area", "m²", [](const D& d) { return measured_cell(d, d.metrics->area_m2); }},
          {"Confidence", "%", [](const D& d) { return fixed_cell(100 * d.confidence, 0); }},
          {"Volume", "L", [](const D& d) { return measured_cell(d, scaled(d.metrics->volume_m3, litres)); }},
          {"Length", "m", [](const D& d) { return plain_cell(d, d.metrics->length_m); }},
          {"Width", "m", [](const D& d) { return plain_cell(d, d.metrics->width_m); }},
          {"Distance", "m", [](const D& d) { return fixed_cell(d.metrics->distance_m, 2); }}};
}

std::vector<Column> pixel_columns() {
  using D = Damage;
  return {{"#", "", id_cell},
          {"Distress", "", distress_cell},
          {"Confidence", "%", [](const D& d) { return fixed_cell(100 * d.confidence, 0); }},
          {"Max change", "px", [](const D& d) { return measured_cell(d.max_depth_px); }},
          {"Mean change", "px", [](const D& d) { return plain_cell(d.mean_depth_px); }},
          {"Size", "px", [](const D& d) { return fixed_cell(static_cast<double>(d.pixels), 0); }},
          {"Centre u", "px", [](const D& d) { return fixed_cell(d.centroid_px[0], 0); }},
          {"Centre v", "px", [](const D& d) { return fixed_cell(d.centroid_px[1], 0); }},
          {"Measured", "%", [](const D& d) { return fixed_cell(100 * d.measured_share, 0); }}};
}

bool all_metric(const DamageMap& map) {
  const auto is_metric = [](const Damage& damage) { return damage.metrics.has_value(); };
  return std::all_of(map.damages.begin(), map.damages.end(), is_metric) &&
         std::all_of(map.candidates.begin(), map.candidates.end(), is_metric);
}

}  // namespace

namespace {

std::string table_of(const DamageMap& map, const std::vector<Damage>& rows, bool linked, const Fields& texts) {
  if (rows.empty()) return "";
  std::vector<Column> columns = all_metric(map) ? metric_columns() : pixel_columns();
  if (!linked) columns.front().cell = [](const Damage& damage) { return fixed_cell(damage.id, 0); };
  Fields fields = texts;
  fields["headings"] = report_headings(columns);
  fields["rows"] = report_rows(columns, rows);
  return fill(templates::table, fields);
}

}  // namespace

std::string damage_list(const DamageMap& map) {
  return table_of(
      map, map.damages, true,
      {{"id", "list"}, {"title", "All damages"}, {"hint", std::string(sorting_hint) + " ± is one standard error."}});
}

std::string candidate_list(const DamageMap& map) {
  return table_of(map, map.candidates, false,
                  {{"id", "candidates"},
                   {"title", "Candidates"},
                   {"hint",
                    "Regions that may be damage, but whose confidence is too low or whose depth is below three "
                    "standard errors of the "
                    "noise. They are not counted above."}});
}

}  // namespace roadstereo::io
