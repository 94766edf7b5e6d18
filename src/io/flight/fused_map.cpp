#include "io/flight/fused_map.hpp"

#include "io/report/cells.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;  // in a metre

/// The best finding with the fused figures, as cells of a report show it.
Damage fused(const RoadDamageRecord& record) {
  Damage damage = record.best.damage;
  if (damage.metrics) {
    // severity_text() tells a range only where these are known.
    damage.metrics->area_m2 = record.area_m2;
    damage.metrics->max_depth_m = record.max_depth_m;
    damage.metrics->mean_depth_m = record.mean_depth_m;
    damage.metrics->severity = record.severity;
    damage.metrics->severity_probabilities = record.severity_probabilities;
  }
  return damage;
}

std::string table_of(const std::vector<RoadDamageRecord>& damages) {
  if (damages.empty()) return "";
  using R = RoadDamageRecord;
  const std::vector<ReportColumn<R>> columns{
      {"#", "",
       [](const R& r) {
         return ReportCell{std::to_string(r.id), static_cast<double>(r.id)};
       }},
      {"Distress", "", [](const R& r) { return distress_cell(fused(r)); }},
      {"Severity", "", [](const R& r) { return severity_cell(fused(r)); }},
      {"Depth", "mm", [](const R& r) { return measured_cell(scaled(r.max_depth_m, mm)); }},
      {"Area", "m²", [](const R& r) { return measured_cell(r.area_m2); }},
      {"x", "m", [](const R& r) { return fixed_cell(r.best.at_m[0], 2); }},
      {"y", "m", [](const R& r) { return fixed_cell(r.best.at_m[1], 2); }},
      {"Confidence", "%", [](const R& r) { return fixed_cell(100 * r.confidence, 0); }},
      {"Frames", "", [](const R& r) { return fixed_cell(r.sightings, 0); }}};
  return fill(
      templates::table,
      {{"id", "map-damages"},
       {"title", "Damages on the map"},
       {"hint",
        "The numbers are those in the picture. Measurements are fused over all frames; ± is one standard error."},
       {"headings", report_headings(columns)},
       {"rows", report_rows(columns, damages)}});
}

}  // namespace

std::string fused_map_section(const ReportedMap& map) {
  return "<section id=\"map\">\n<h2>Map of the road</h2>\n<figure class=\"wide\"><img src=\"data:image/jpeg;base64," +
         base64(map.picture) +
         "\" alt=\"Orthophoto and heights of the road with its damages\"><figcaption>Orthophoto, and heights above the "
         "smooth surface of the road, fused from all frames of the longest linked piece; map/ has the rasters."
         "</figcaption></figure>\n</section>\n" +
         table_of(map.damages);
}

}  // namespace roadstereo::io
