#include <algorithm>
#include <cmath>

#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/flight/templates.hpp"
#include "io/plot.hpp"
#include "io/report/cells.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/summary.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/io/image_file.hpp"
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
  if (input.damages == 0) {
    html +=
        "<p class=\"notice good\"><strong>No damage found.</strong> No part of the visible road deviates from its "
        "surface by more than the resolvable depth of this rig.</p>";
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
  return "<section id=\"strip\"><h2>The flight</h2>\n<ul class=\"strip\" tabindex=\"0\" aria-label=\"Frames of the "
         "flight\">\n" +
         items + "</ul></section>\n";
}

using Row = PicturedDamage;
using Column = ReportColumn<Row>;

std::string seconds_text(double time_s) {
  return std::isfinite(time_s) ? number_text(time_s, 2) : "";
}

std::vector<Column> identity_columns() {
  return {{"#", "", [](const Row& r) { return fixed_cell(static_cast<double>(r.damage.id), 0); }},
          {"Picture", "",
           [](const Row& r) -> ReportCell {
             if (r.jpeg.empty()) return {};
             return {"<img src=\"" + jpeg_uri(r.jpeg) + "\" alt=\"damage " + std::to_string(r.damage.id) + "\">", {}};
           }},
          {"Kind", "", [](const Row& r) -> ReportCell {
             return {name_of(r.damage.best.kind), {}};
           }}};
}

std::vector<Column> sighting_columns() {
  return {{"Sightings", "", [](const Row& r) { return fixed_cell(static_cast<double>(r.damage.sightings), 0); }},
          {"Frame", "",
           [](const Row& r) -> ReportCell {
             return {escaped(r.damage.frame_name), static_cast<double>(r.damage.frame)};
           }},
          {"Time", "s", [](const Row& r) -> ReportCell {
             return {seconds_text(r.damage.time_s), r.damage.time_s};
           }}};
}

/// A metric value of a damage.
template <class Figure>
ReportCell metric_cell(const Row& row, const Figure& figure) {
  if (!row.damage.best.metrics) return {"", std::numeric_limits<double>::quiet_NaN()};
  return figure(*row.damage.best.metrics);
}

std::vector<Column> metric_columns() {
  using M = DamageMetrics;
  return {
      {"Severity", "", [](const Row& r) { return severity_cell(r.damage.best); }},
      {"Max depth", "mm",
       [](const Row& r) {
         return metric_cell(r, [](const M& m) { return measured_cell(scaled(m.max_depth_m, mm)); });
       }},
      {"Area", "m²", [](const Row& r) { return metric_cell(r, [](const M& m) { return measured_cell(m.area_m2); }); }},
      {"Volume", "L",
       [](const Row& r) {
         return metric_cell(r, [](const M& m) { return measured_cell(scaled(m.volume_m3, litres)); });
       }},
      {"Length", "m", [](const Row& r) { return metric_cell(r, [](const M& m) { return plain_cell(m.length_m); }); }},
      {"Width", "m", [](const Row& r) { return metric_cell(r, [](const M& m) { return plain_cell(m.width_m); }); }},
      {"Distance", "m",
       [](const Row& r) { return metric_cell(r, [](const M& m) { return fixed_cell(m.distance_m, 2); }); }},
      {"Resolvable", "mm",
       [](const Row& r) { return metric_cell(r, [](const M& m) { return plain_cell(m.resolvable_depth_m * mm); }); }}};
}

std::vector<Column> pixel_columns() {
  return {{"Max change", "px", [](const Row& r) { return measured_cell(r.damage.best.max_depth_px); }},
          {"Size", "px", [](const Row& r) { return fixed_cell(static_cast<double>(r.damage.best.pixels), 0); }}};
}

std::string damages_of(const FlightReportInput& input) {
  if (input.worst.empty()) return "";
  std::vector<Column> columns = identity_columns();
  for (const auto& part : {input.metric ? metric_columns() : pixel_columns(), sighting_columns()}) {
    columns.insert(columns.end(), part.begin(), part.end());
  }
  std::string hint = sorting_hint;
  if (input.worst.size() < input.damages) {
    hint = "The worst " + std::to_string(input.worst.size()) + " of " + std::to_string(input.damages) +
           " damages; all are in damages.csv. " + hint;
  }
  return fill(templates::table, {{"id", "damages"},
                                 {"title", "Damages by severity"},
                                 {"hint", hint},
                                 {"headings", report_headings(columns)},
                                 {"rows", report_rows(columns, input.worst)}});
}

bool has_points(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string plot_of(const FlightCurves& curves, const std::vector<double>& values, const std::string& title,
                    const std::string& label) {
  constexpr int width = 1100;
  constexpr int height = 260;
  if (!has_points(values)) return "";
  Panel panel;
  panel.title = title;
  panel.x_label = curves.in_seconds ? "time since the first frame, s" : "frame";
  panel.y_label = label;
  panel.curves.push_back({"", curves.time, values, values.size() == 1});
  const std::vector<std::uint8_t> png = encode_png(draw_plot(panel, width, height).view());
  return "<figure class=\"plot\"><img src=\"data:image/png;base64," + base64(png) + "\" alt=\"" +
         escaped(title + ", " + label) + "\"></figure>\n";
}

std::string plots_of(const FlightCurves& curves) {
  const std::string plots = plot_of(curves, curves.roll_deg, "Roll", "roll, deg") +
                            plot_of(curves, curves.height_m, "Height above the road", "height, m") +
                            plot_of(curves, curves.sigma_d_px, "Standard deviation on the road", "sigma_d, px");
  if (plots.empty()) return "";
  return "<section id=\"plots\"><h2>Time series</h2>\n" + plots + "</section>\n";
}

}  // namespace

std::string flight_report(const FlightReportInput& input) {
  Fields fields;
  fields["title"] = input.title;
  fields["colours"] = severity_colours();
  fields["style"] = std::string(templates::style);
  fields["flight_style"] = std::string(flight_templates::style);
  fields["version"] = version;
  fields["notices"] = notices_of(input);
  fields["cards"] = "";
  fields["properties"] = property_list(input.properties);
  fields["strip"] = thumbnails_of(input.thumbnails);
  fields["damages"] = damages_of(input);
  fields["legend"] = input.metric && !input.worst.empty() ? severity_legend() : "";
  fields["plots"] = plots_of(input.curves);
  fields["scripts"] = std::string(templates::sorting);
  return fill(flight_templates::document, fields);
}

}  // namespace roadstereo::io
