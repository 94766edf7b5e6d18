#include "io/report/cells.hpp"

#include <cmath>

#include "core/shortest_text.hpp"
#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"

namespace roadstereo::io {
namespace {

/// Attribute with the sort key of a cell; empty: unknown.
std::string key_attribute(const ReportCell& cell) {
  if (!cell.key) return "";
  if (!std::isfinite(*cell.key)) return " data-key=\"\"";
  return " data-key=\"" + shortest_text(*cell.key) + "\"";
}

}  // namespace

ReportCell measured_cell(const Measurement& measured) {
  return {escaped(measured_text(measured, "")), measured.value};
}

ReportCell measured_cell(const Damage& damage, const Measurement& size) {
  return {escaped(bound_text(damage.cut_by_border, measured_text(size, ""))), size.value};
}

ReportCell plain_cell(double value) {
  return {escaped(value_text(value, "")), value};
}

ReportCell plain_cell(const Damage& damage, double size) {
  return {escaped(bound_text(damage.cut_by_border, value_text(size, ""))), size};
}

ReportCell fixed_cell(double value, int decimals) {
  return {std::isfinite(value) ? number_text(value, decimals) : "", value};
}

ReportCell severity_cell(const Damage& damage) {
  const Severity severity = severity_of(damage);
  const std::string text = damage.metrics ? severity_text(*damage.metrics) : name_of(severity);
  return {"<span class=\"chip " + std::string(name_of(severity)) + "\">" + text + "</span>",
          static_cast<double>(severity)};
}

ReportCell distress_cell(const Damage& damage) {
  return {damage.metrics ? name_of(damage.metrics->distress) : name_of(damage.kind), {}};
}

std::string report_heading(const std::string& title, const std::string& unit) {
  const std::string small = unit.empty() ? "" : " <small>" + escaped(unit) + "</small>";
  return "<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">" + escaped(title) + small + "</button></th>";
}

std::string report_cell(const ReportCell& cell) {
  return "<td" + key_attribute(cell) + ">" + cell.html + "</td>";
}

}  // namespace roadstereo::io
