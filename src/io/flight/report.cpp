#include <algorithm>
#include <cmath>
#include <set>

#include "core/degrees.hpp"
#include "io/drawing.hpp"
#include "io/flight/fused_map.hpp"
#include "io/flight/road_map.hpp"
#include "io/flight/templates.hpp"
#include "io/geo/utc_time.hpp"
#include "io/report/cells.hpp"
#include "io/report/curve.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/pictures.hpp"
#include "io/report/summary.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

std::string jpeg_uri(const std::vector<std::uint8_t>& jpeg) {
  return "data:image/jpeg;base64," + base64(jpeg);
}

std::string notices_of(const FlightReportInput& input) {
  std::string html;
  for (const std::string& notice : input.notices) html += "<p class=\"notice\">" + escaped(notice) + "</p>\n";
  const auto frames = static_cast<std::int64_t>(input.curves.time.size());
  const std::size_t in_map = input.map ? input.map->damages.size() : 0;
  if (input.inspected == 0) {
    html +=
        "<p class=\"notice\"><strong>Not inspected.</strong> Damage could not be searched for in any frame: see "
        "frames.csv.</p>";
  } else if (input.damages.empty() && in_map > 0) {
    html += "<p class=\"notice\"><strong>No damage found in single frames.</strong> Their map shows " +
            std::to_string(in_map) + ": see \"Damages on the map\".</p>";
  } else if (input.damages.empty()) {
    const std::int64_t seen = input.inspected - (input.limits.doubts.empty() ? input.untrusted : 0);
    const std::string where =
        seen < frames ? " in " + std::to_string(seen) + " of " + std::to_string(frames) + " frames" : "";
    html += no_damage_notice(where, !input.candidates.empty(), input.limits, input.flawed);
  }
  if (!input.metric) {
    html +=
        "<p class=\"notice\"><strong>Pixels only.</strong> Without a calibration there are no metric values and no "
        "severities.</p>";
  }
  return html;
}

std::string thumbnails_of(const std::vector<CaptionedPicture>& strip) {
  if (strip.empty()) return "";
  std::string items;
  for (const CaptionedPicture& picture : strip) {
    items += "<li><img src=\"" + jpeg_uri(picture.jpeg) + "\" alt=\"" + escaped(picture.caption) + "\"><small>" +
             escaped(picture.caption) + "</small></li>\n";
  }
  return "<h3>Frames</h3>\n<ul class=\"strip\" tabindex=\"0\" aria-label=\"Frames of the recording\">\n" + items +
         "</ul>\n";
}

using Column = ReportColumn<RoadDamage>;

/// A metric value of a damage.
template <class Figure>
ReportCell metric_cell(const RoadDamage& damage, const Figure& figure) {
  if (!damage.best.metrics) return {"", std::numeric_limits<double>::quiet_NaN()};
  return figure(*damage.best.metrics);
}

/// Number of a damage: a link to its section, or else what links to the damage lead to.
ReportCell id_cell(const RoadDamage& damage, bool has_section) {
  const std::string id = std::to_string(damage.id);
  const auto value = static_cast<double>(damage.id);
  if (damage.candidate) return {id, value};
  return {has_section ? damage_link(damage.id, id) : "<span id=\"damage-" + id + "\">" + id + "</span>", value};
}

std::string place_text(const GeoPosition& position) {
  constexpr int decimals = 6;
  return number_text(position.lat_deg, decimals) + ", " + number_text(position.lon_deg, decimals);
}

ReportCell place_cell(const RoadDamage& damage) {
  return {damage.position ? place_text(*damage.position) : "", damage.station_m};
}

ReportCell quantity_cell(const RoadDamage& damage) {
  if (!damage.best.metrics) return {};
  const DamageMetrics& metrics = *damage.best.metrics;
  const char* const unit = metrics.unit == DistressUnit::square_metre ? "m²"
                           : metrics.unit == DistressUnit::metre      ? "m"
                                                                      : "";
  if (metrics.quantity == 1 && unit[0] == 0) return {"1", 1};
  return {escaped(bound_text(damage.best.cut_by_border, value_text(metrics.quantity, unit))), metrics.quantity};
}

std::vector<Column> damage_columns_of(const FlightReportInput& input) {
  using D = RoadDamage;
  using M = DamageMetrics;
  std::set<std::int64_t> with_section;
  for (const ReportedDamage& reported : input.damages) {
    if (!reported.section.empty()) with_section.insert(reported.damage.id);
  }
  std::vector<Column> columns{{"#", "", [with_section](const D& d) { return id_cell(d, with_section.contains(d.id)); }},
                              {"Distress", "", [](const D& d) { return distress_cell(d.best); }}};
  if (input.metric) {
    columns.push_back({"Severity", "", [](const D& d) { return severity_cell(d.best); }});
    columns.push_back({"Depth", "mm", [](const D& d) {
                         return metric_cell(d, [](const M& m) { return measured_cell(scaled(m.max_depth_m, mm)); });
                       }});
    columns.push_back({"Area", "m²", [](const D& d) {
                         return metric_cell(d, [&](const M& m) { return measured_cell(d.best, m.area_m2); });
                       }});
    columns.push_back({"Quantity", "", quantity_cell});
  } else {
    columns.push_back({"Max change", "px", [](const D& d) { return measured_cell(d.best.max_depth_px); }});
    columns.push_back({"Size", "px", [](const D& d) { return fixed_cell(static_cast<double>(d.best.pixels), 0); }});
  }
  if (!input.track_deg.empty()) {
    columns.push_back({"Latitude, longitude", "°", place_cell});
    columns.push_back({"Station", "m", [](const D& d) { return fixed_cell(d.station_m, 0); }});
  }
  columns.push_back({"Confidence", "%", [](const D& d) { return fixed_cell(100 * d.best.confidence, 0); }});
  columns.push_back({"Frames", "", [](const D& d) { return fixed_cell(static_cast<double>(d.sightings), 0); }});
  return columns;
}

std::string table_of(const FlightReportInput& input, const std::string& id, const std::string& title,
                     const std::string& hint, const std::vector<RoadDamage>& rows) {
  if (rows.empty()) return "";
  const std::vector<Column> columns = damage_columns_of(input);
  return fill(templates::table, {{"id", id},
                                 {"title", title},
                                 {"hint", hint},
                                 {"headings", report_headings(columns)},
                                 {"rows", report_rows(columns, rows)}});
}

std::string damages_of(const FlightReportInput& input) {
  std::vector<RoadDamage> rows;
  for (const ReportedDamage& reported : input.damages) {
    if (rows.size() < max_damage_rows) rows.push_back(reported.damage);
  }
  std::string hint = std::string(sorting_hint) + " ± is one standard error; ≥: cut by the border in every frame.";
  if (rows.size() < input.damages.size()) {
    hint = "The worst " + std::to_string(rows.size()) + " of " + std::to_string(input.damages.size()) +
           " damages; all are in damages.csv. " + hint;
  }
  return table_of(input, "damages", "Damages by severity", hint, rows);
}

std::string candidates_of(const FlightReportInput& input) {
  constexpr std::size_t max_rows = 50;
  std::vector<RoadDamage> rows = input.candidates;
  rows.resize(std::min(rows.size(), max_rows));
  return table_of(
      input, "candidates", "Candidates",
      "Regions that may be damage, but whose confidence is too low or whose depth is below three standard errors of "
      "the noise. They are not counted above. Number in candidates.csv: " +
          std::to_string(input.candidates.size()) + ".",
      rows);
}

/// Size of a damage that the border cuts in all of several frames: what these show together.
std::vector<std::pair<std::string, std::string>> sizes_of(const RoadDamage& damage) {
  if (!damage.best.cut_by_border || !damage.best.metrics || damage.sightings == 1) return {};
  const DamageMetrics& metrics = *damage.best.metrics;
  return {{"area over all frames", bound_text(true, measured_text(metrics.area_m2, "m²"))},
          {"volume over all frames", bound_text(true, measured_text(scaled(metrics.volume_m3, litres), "L"))},
          {"length over all frames", bound_text(true, value_text(metrics.length_m, "m"))}};
}

std::string where_html(const FlightReportInput& input, const RoadDamage& damage) {
  std::vector<std::pair<std::string, std::string>> places;
  if (damage.position) places.emplace_back("latitude, longitude", place_text(*damage.position));
  if (std::isfinite(damage.station_m)) places.emplace_back("station", number_text(damage.station_m, 1) + "\u00a0m");
  places.emplace_back("measured in frame", damage.frame_name);
  if (input.curves.in_seconds && std::isfinite(damage.time_s)) {
    const std::optional<UtcTime> time = utc_time(damage.time_s);
    places.emplace_back("time", time ? iso_text(*time) : number_text(damage.time_s, 2) + "\u00a0s");
  }
  places.emplace_back("seen in", std::to_string(damage.sightings) + (damage.sightings == 1 ? " frame" : " frames"));
  const auto sizes = sizes_of(damage);
  places.insert(places.end(), sizes.begin(), sizes.end());
  return property_list(places);
}

std::string sections_of(const FlightReportInput& input) {
  std::string html;
  for (const ReportedDamage& reported : input.damages) {
    if (!reported.section.empty()) html += fill(reported.section, {{"where", where_html(input, reported.damage)}});
  }
  return html.empty() ? html : "<h2>Damage details</h2>\n" + html;
}

std::string segments_of(const FlightReportInput& input) {
  if (input.segments.empty()) return "";
  using S = RoadSegment;
  std::set<std::int64_t> with_row;
  for (std::size_t i = 0; i < std::min(input.damages.size(), max_damage_rows); ++i) {
    with_row.insert(input.damages[i].damage.id);
  }
  const std::vector<ReportColumn<S>> columns{
      {"From", "m", [](const S& s) { return fixed_cell(s.from_m, 0); }},
      {"To", "m", [](const S& s) { return fixed_cell(s.to_m, 0); }},
      {"Damages", "",
       [](const S& s) {
         return s.inspected > 0 ? fixed_cell(static_cast<double>(s.damages), 0) : ReportCell{"not inspected", -1.0};
       }},
      {"Area", "m²",
       [](const S& s) {
         return s.damages > 0 ? plain_cell(s.area_m2) : ReportCell{"", 0.0};
       }},
      {"Worst", "",
       [&with_row](const S& s) -> ReportCell {
         if (s.worst == 0) return {"", 0.0};
         const std::string id = std::to_string(s.worst);
         return {with_row.contains(s.worst) ? damage_link(s.worst, id) : id, static_cast<double>(s.worst)};
       }},
      {"Roll", "°", [](const S& s) { return fixed_cell(to_degrees(s.roll_rad), 2); }},
      {"Camera height", "m", [](const S& s) { return fixed_cell(s.height_m, 2); }}};
  return fill(templates::table, {{"id", "segments"},
                                 {"title", "Segments of the road"},
                                 {"hint", "Stations are distances along the positions of the frames."},
                                 {"headings", report_headings(columns)},
                                 {"rows", report_rows(columns, input.segments)}});
}

std::string map_of(const FlightReportInput& input) {
  const std::string svg = road_map_svg(input);
  if (svg.empty()) return "";
  return "<figure class=\"wide\">" + svg +
         "<figcaption>Path of the camera and damages by severity; north is up, the ring marks the start.</figcaption>"
         "</figure>\n";
}

std::string cards_of(const FlightReportInput& input) {
  std::vector<Damage> damages;
  for (const ReportedDamage& reported : input.damages) {
    damages.push_back(reported.damage.best);
    damages.back().id = static_cast<int>(reported.damage.id);
  }
  return damages_cards(damages, max_damage_rows, input.candidates.size(), input.metric);
}

bool has_points(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string plot_of(const FlightCurves& curves, const std::vector<double>& values, const std::string& label) {
  if (!has_points(values)) return "";
  return "<figure class=\"plot\">" +
         curve_svg(curves.time, values, curves.in_seconds ? "time since the first frame, s" : "frame", label) +
         "</figure>\n";
}

std::string plots_of(const FlightCurves& curves) {
  const std::string plots = plot_of(curves, curves.roll_deg, "roll, °") +
                            plot_of(curves, curves.height_m, "camera height, m") +
                            plot_of(curves, curves.sigma_d_px, "σ_d on the road, px");
  return plots.empty() ? plots : "<h3>Time series</h3>\n" + plots;
}

}  // namespace

std::string flight_report(const FlightReportInput& input) {
  Fields fields;
  fields["title"] = input.title;
  fields["colours"] = severity_colours() + depth_colours();
  fields["style"] = std::string(templates::style);
  fields["flight_style"] = std::string(flight_templates::style);
  fields["version"] = version;
  fields["head"] = property_list(input.head);
  fields["notices"] = notices_of(input);
  fields["cards"] = cards_of(input);
  fields["map"] = map_of(input);
  fields["properties"] = property_list(input.properties);
  fields["strip"] = thumbnails_of(input.thumbnails);
  fields["fused"] = input.map ? fused_map_section(*input.map) : "";
  fields["damages"] = damages_of(input);
  fields["segments"] = segments_of(input);
  fields["sections"] = sections_of(input);
  fields["candidates"] = candidates_of(input);
  fields["legend"] = input.metric && !input.damages.empty() ? severity_legend(input.severity) : "";
  fields["plots"] = plots_of(input.curves);
  fields["palette"] = depth_palette_json();
  fields["scripts"] = std::string(templates::sorting) + std::string(templates::relief3d);
  return fill(flight_templates::document, fields);
}

}  // namespace roadstereo::io
