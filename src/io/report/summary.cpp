#include "io/report/summary.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/warning.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

constexpr std::array known_severities{Severity::high,      Severity::medium,       Severity::low,    Severity::minor,
                                      Severity::uncertain, Severity::unresolvable, Severity::unknown};

std::string card(const std::string& name, const std::string& value, const std::string& more) {
  return "<div class=\"card\"><div class=\"name\">" + escaped(name) + "</div><div class=\"value\">" + escaped(value) +
         "</div><div class=\"more\">" + more + "</div></div>";
}

using Damages = std::vector<Damage>;

std::size_t count_of(const Damages& damages, DamageKind kind) {
  return static_cast<std::size_t>(
      std::count_if(damages.begin(), damages.end(), [kind](const Damage& damage) { return damage.kind == kind; }));
}

/// "2 potholes, 1 rut".
std::string distress_counts(const Damages& damages) {
  std::map<std::string, int> counts;
  for (const Damage& damage : damages) {
    ++counts[damage.metrics ? name_of(damage.metrics->distress) : name_of(damage.kind)];
  }
  std::string text;
  for (const auto& [name, count] : counts) {
    const bool plural = count > 1 && name != "debris";
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name + (plural ? "s" : "");
  }
  return text;
}

std::string chip(Severity severity, const std::string& text) {
  return "<span class=\"chip " + std::string(name_of(severity)) + "\">" + text + "</span> ";
}

std::string severity_chips(const Damages& damages) {
  std::string html;
  for (const Severity severity : known_severities) {
    const auto count = std::count_if(damages.begin(), damages.end(),
                                     [severity](const Damage& damage) { return severity_of(damage) == severity; });
    const std::string name = severity == Severity::unknown ? "not graded" : name_of(severity);
    if (count > 0) html += chip(severity, std::to_string(count) + " " + name);
  }
  return html;
}

/// Sum of a value over the damages of a kind; the errors are taken as independent.
template <auto Member>
Measurement total(const Damages& damages, DamageKind kind) {
  Measurement sum;
  for (const Damage& damage : damages) {
    if (damage.kind != kind || !damage.metrics) continue;
    const Measurement& measured = (*damage.metrics).*Member;
    sum.value += measured.value;
    sum.std_error = std::hypot(sum.std_error, measured.std_error);
  }
  return sum;
}

std::string total_cards(const Damages& damages, DamageKind kind) {
  const bool below = kind == DamageKind::depression;
  const Measurement area = total<&DamageMetrics::area_m2>(damages, kind);
  const Measurement volume = total<&DamageMetrics::volume_m3>(damages, kind);
  const bool is_least = std::any_of(damages.begin(), damages.end(), [kind](const Damage& damage) {
    return damage.kind == kind && damage.metrics && damage.cut_by_border;
  });
  return card(below ? "Below the road" : "Above the road", bound_text(is_least, measured_text(area, "m²")),
              escaped((below ? "missing volume " : "raised volume ") +
                      bound_text(is_least, measured_text(scaled(volume, litres), "L"))));
}

std::string deepest_card(const Damages& damages, std::size_t listed) {
  const auto at = std::max_element(damages.begin(), damages.end(), [](const Damage& one, const Damage& other) {
    return one.max_depth().value < other.max_depth().value;
  });
  const Damage& deepest = *at;
  const bool has_link = static_cast<std::size_t>(at - damages.begin()) < listed;
  const std::string name = "damage " + std::to_string(deepest.id);
  const std::string link = has_link ? damage_link(deepest.id, name) : name;
  if (!deepest.metrics) return card("Maximum disparity change", measured_text(deepest.max_depth_px, "px"), link);
  const bool below = deepest.kind == DamageKind::depression;
  return card(below ? "Maximum depth" : "Maximum height", measured_text(scaled(deepest.metrics->max_depth_m, mm), "mm"),
              link);
}

}  // namespace

std::string damages_cards(const Damages& damages, std::size_t listed, std::size_t candidates, bool metric) {
  if (damages.empty()) return "";
  const std::string apart = candidates == 0 ? ""
                                            : "; " + std::to_string(candidates) +
                                                  (candidates == 1 ? " candidate" : " candidates") + " not counted";
  std::string cards = card("Damages", std::to_string(damages.size()), distress_counts(damages) + apart);
  if (metric) {
    cards += "<div class=\"card\"><div class=\"name\">Severity</div><div class=\"chips\">" + severity_chips(damages) +
             "</div></div>";
  }
  cards += deepest_card(damages, listed);
  for (const DamageKind kind : {DamageKind::depression, DamageKind::protrusion}) {
    if (metric && count_of(damages, kind) > 0) cards += total_cards(damages, kind);
  }
  return "<div class=\"cards\">" + cards + "</div>";
}

std::string no_damage_notice(const std::string& where, bool has_candidates, const InspectionLimits& limits,
                             bool flawed) {
  if (!limits.doubts.empty()) {
    std::string reasons;
    for (const std::string& doubt : limits.doubts) reasons += "<li>" + escaped(doubt) + ".</li>";
    return "<div class=\"notice\"><strong>No damage found" + where +
           ", but the road was not inspected reliably.</strong> There may be damage that was missed:<ul>" + reasons +
           "</ul></div>";
  }
  std::string text = has_candidates ? "Regions that may be damage are listed as candidates."
                                    : "No part of the visible road deviates from its surface by more than the "
                                      "resolvable depth of this rig.";
  if (!limits.limit.empty()) text += " The limit is " + limits.limit + ".";
  const bool good = !has_candidates && !flawed;
  return std::string("<p class=\"notice") + (good ? " good" : "") + "\"><strong>No damage found" + where +
         ".</strong> " + escaped(text) + "</p>";
}

namespace {

/// Whether the notice that no damage was found says the same.
bool is_told(const std::string& warning, const InspectionLimits& limits) {
  return std::any_of(limits.doubts.begin(), limits.doubts.end(),
                     [&](const std::string& doubt) { return warning.find(doubt) != std::string::npos; });
}

std::string warning_notice(const std::string& warning) {
  const std::string_view code = warning_code(warning);
  const std::string text = code.empty() ? warning : warning.substr(code.size() + 2);
  return "<p class=\"notice\"><strong>Warning" + (code.empty() ? "" : " (" + escaped(std::string(code)) + ")") +
         ":</strong> " + escaped(text) + ".</p>";
}

}  // namespace

std::string summary_notices(const DamageReportInput& input) {
  const DamageMap& map = input.map;
  std::string notices;
  const bool tells_doubts = map.has_road() && map.damages.empty();
  if (!map.has_road()) {
    notices = "<p class=\"notice\"><strong>Not inspected.</strong> Damage could not be searched for: " +
              escaped(map.non_metric_reason) + ".</p>";
  } else {
    if (tells_doubts) notices += no_damage_notice("", !map.candidates.empty(), input.limits, !input.warnings.empty());
    if (!map.metric) {
      const std::string why = map.non_metric_reason.empty() ? "the frame has no calibration" : map.non_metric_reason;
      notices += "<p class=\"notice\"><strong>Pixels only.</strong> There are no metric values and no severities: " +
                 escaped(why) + ".</p>";
    }
  }
  for (const std::string& warning : input.warnings) {
    if (!tells_doubts || !is_told(warning, input.limits)) notices += warning_notice(warning);
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

namespace {

/// A limit of a scheme as its file has it.
std::string limit_text(double limit_m) {
  constexpr double steps_per_mm = 1e6;  // finer digits are those of the conversion to metres
  const double limit_mm = std::round(mm * limit_m * steps_per_mm) / steps_per_mm;
  std::array<char, 400> text{};  // more than the largest number has
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), limit_mm, std::chars_format::fixed).ptr};
}

/// "13 – 25 mm", or "over 50 mm" for the last limit.
std::string interval_text(const std::vector<double>& limits_m, std::size_t i) {
  const std::string from = limit_text(limits_m[i]);
  if (i + 1 == limits_m.size()) return "over " + from + " mm";
  return from + " – " + limit_text(limits_m[i + 1]) + " mm";
}

std::string table_html(const SeverityTable& table) {
  const bool wide = !table.diameters_m.empty();
  std::string html = "<div class=\"scroll\"><table><caption>" + std::string(name_of(table.distress)) + ", " +
                     (table.unit == DistressUnit::square_metre ? "m²" : name_of(table.unit)) +
                     "</caption><thead><tr><th scope=\"col\">Depth</th>";
  for (std::size_t j = 0; j < table.diameters_m.size(); ++j) {
    html += "<th scope=\"col\">" + interval_text(table.diameters_m, j) + " wide</th>";
  }
  html += wide ? "</tr></thead>" : "<th></th></tr></thead>";
  for (std::size_t i = 0; i < table.depths_m.size(); ++i) {
    html += "<tr><th scope=\"row\">" + interval_text(table.depths_m, i) + "</th>";
    for (const Severity severity : table.classes[i]) html += "<td>" + chip(severity, name_of(severity)) + "</td>";
    html += "</tr>";
  }
  return html + "</table></div>";
}

}  // namespace

std::string severity_legend(const SeverityScheme& scheme) {
  std::string tables;
  for (const SeverityTable& table : scheme.tables) {
    if (!table.classes.empty()) tables += table_html(table);
  }
  return fill(templates::legend, {{"name", scheme.name}, {"tables", tables}});
}

std::string severity_colours() {
  std::string css;
  const auto add = [&css](const std::string& name, const Rgb& colour) {
    css += "--" + name + ":rgb(" + std::to_string(colour[0]) + "," + std::to_string(colour[1]) + "," +
           std::to_string(colour[2]) + ");";
  };
  for (const Severity severity : known_severities) {
    if (severity != Severity::unknown) add(name_of(severity), damage_colour(DamageKind::depression, severity));
  }
  for (const DamageKind kind : {DamageKind::depression, DamageKind::protrusion}) {
    add(name_of(kind), damage_colour(kind, Severity::unknown));
  }
  return ":root{" + css + "}";
}

}  // namespace roadstereo::io
