#include "io/report/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/damage_colours.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

constexpr std::array<Severity, 6> known_severities{Severity::high,  Severity::medium,    Severity::low,
                                                   Severity::minor, Severity::uncertain, Severity::unresolvable};

std::string card(const std::string& name, const std::string& value, const std::string& more) {
  return "<div class=\"card\"><div class=\"name\">" + escaped(name) + "</div><div class=\"value\">" + escaped(value) +
         "</div><div class=\"more\">" + more + "</div></div>";
}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::size_t count_of(const DamageMap& map, DamageKind kind) {
  return static_cast<std::size_t>(std::count_if(map.damages.begin(), map.damages.end(),
                                                [kind](const Damage& damage) { return damage.kind == kind; }));
}

std::string chip(Severity severity, const std::string& text) {
  return "<span class=\"chip " + std::string(name_of(severity)) + "\">" + text + "</span> ";
}

std::string severity_chips(const DamageMap& map) {
  std::string html;
  for (const Severity severity : known_severities) {
    const auto count = std::count_if(map.damages.begin(), map.damages.end(),
                                     [severity](const Damage& damage) { return severity_of(damage) == severity; });
    if (count > 0) html += chip(severity, std::to_string(count) + " " + name_of(severity));
  }
  return html;
}

/// Sum of a value over the damages of a kind; the errors are taken as independent.
template <auto Member>
Measurement total(const DamageMap& map, DamageKind kind) {
  Measurement sum;
  for (const Damage& damage : map.damages) {
    if (damage.kind != kind || !damage.metrics) continue;
    const Measurement& measured = (*damage.metrics).*Member;
    sum.value += measured.value;
    sum.std_error = std::hypot(sum.std_error, measured.std_error);
  }
  return sum;
}

std::string total_cards(const DamageMap& map, DamageKind kind) {
  const bool below = kind == DamageKind::depression;
  const Measurement area = total<&DamageMetrics::area_m2>(map, kind);
  const Measurement volume = total<&DamageMetrics::volume_m3>(map, kind);
  return card(below ? "Depressions" : "Protrusions", measured_text(area, "m²"),
              escaped((below ? "missing volume " : "raised volume ") + measured_text(scaled(volume, litres), "L")));
}

std::string deepest_card(const DamageMap& map) {
  const Damage& deepest = map.damages.front();
  const std::string link = "<a href=\"#damage-" + std::to_string(deepest.id) + "\">damage " +
                           std::to_string(deepest.id) + "</a>, a " + name_of(deepest.kind);
  if (!deepest.metrics) return card("Maximum disparity change", measured_text(deepest.max_depth_px, "px"), link);
  const bool below = deepest.kind == DamageKind::depression;
  return card(below ? "Maximum depth" : "Maximum height", measured_text(scaled(deepest.metrics->max_depth_m, mm), "mm"),
              link);
}

}  // namespace

std::string summary_cards(const DamageMap& map) {
  if (map.damages.empty()) return "";
  const std::size_t depressions = count_of(map, DamageKind::depression);
  const std::size_t protrusions = count_of(map, DamageKind::protrusion);
  std::string cards = card("Damages", std::to_string(map.damages.size()),
                           counted(depressions, "depression") + ", " + counted(protrusions, "protrusion"));
  if (map.metric) {
    cards += "<div class=\"card\"><div class=\"name\">Severity</div><div class=\"chips\">" + severity_chips(map) +
             "</div></div>";
  }
  cards += deepest_card(map);
  if (map.metric && depressions > 0) cards += total_cards(map, DamageKind::depression);
  if (map.metric && protrusions > 0) cards += total_cards(map, DamageKind::protrusion);
  return "<div class=\"cards\">" + cards + "</div>";
}

std::string summary_notices(const DamageMap& map) {
  std::string notices;
  if (map.damages.empty()) {
    notices +=
        "<p class=\"notice good\"><strong>No damage found.</strong> No part of the visible road deviates from its "
        "surface by more than the resolvable depth of this rig.</p>";
  }
  if (!map.metric) {
    const std::string why = map.non_metric_reason.empty() ? "the frame has no calibration" : map.non_metric_reason;
    notices += "<p class=\"notice\"><strong>Pixels only.</strong> There are no metric values and no severities: " +
               escaped(why) + ".</p>";
  }
  return notices;
}

std::string property_list(const std::vector<std::pair<std::string, std::string>>& properties) {
  std::string html;
  for (const auto& [name, value] : properties) {
    html += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>";
  }
  return html.empty() ? html : "<dl class=\"facts\">" + html + "</dl>";
}

std::string severity_legend() {
  struct Row {
    const char* name;
    double depth_m;  // centre of the row
  };
  constexpr std::array<Row, 3> rows{{{"13 – 25 mm", 0.019}, {"25 – 50 mm", 0.037}, {"over 50 mm", 0.07}}};
  constexpr std::array<double, 3> diameters_m{0.15, 0.3, 0.6};  // centres of the columns
  std::string html;
  for (const Row& row : rows) {
    html += "<tr><th scope=\"row\">" + std::string(row.name) + "</th>";
    for (const double diameter_m : diameters_m) {
      const Severity severity = astm_severity(row.depth_m, diameter_m);
      html += "<td>" + chip(severity, name_of(severity)) + "</td>";
    }
    html += "</tr>";
  }
  return fill(templates::legend, {{"rows", html}});
}

std::string severity_colours() {
  std::string css;
  const auto add = [&css](const std::string& name, const Rgb& colour) {
    css += "--" + name + ":rgb(" + std::to_string(colour[0]) + "," + std::to_string(colour[1]) + "," +
           std::to_string(colour[2]) + ");";
  };
  for (const Severity severity : known_severities) {
    add(name_of(severity), damage_colour(DamageKind::depression, severity));
  }
  for (const DamageKind kind : {DamageKind::depression, DamageKind::protrusion}) {
    add(name_of(kind), damage_colour(kind, Severity::unknown));
  }
  return ":root{" + css + "}";
}

}  // namespace roadstereo::io
