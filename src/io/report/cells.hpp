#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// A cell of a report table: its content and its sort key; without a key it is sorted by its text.
struct ReportCell {
  std::string html;
  std::optional<double> key{};
};

ReportCell measured_cell(const Measurement& measured);
/// Shows an area or a volume; with "≥" if the border cuts the damage.
ReportCell measured_cell(const Damage& damage, const Measurement& size);
/// Shows a value with three significant digits.
ReportCell plain_cell(double value);
/// Shows a length or a width; with "≥" if the border cuts the damage.
ReportCell plain_cell(const Damage& damage, double size);
ReportCell fixed_cell(double value, int decimals);
ReportCell severity_cell(const Damage& damage);
/// Shows the distress, or without a calibration the side of the road.
ReportCell distress_cell(const Damage& damage);

/// Hint above sortable tables.
inline constexpr const char* sorting_hint = "Click a column header to sort; click again to reverse the order.";

template <class Row>
struct ReportColumn {
  std::string title;
  std::string unit;
  std::function<ReportCell(const Row& row)> cell;
};

/// Header cell of a column with its sort button.
std::string report_heading(const std::string& title, const std::string& unit);
std::string report_cell(const ReportCell& cell);

template <class Row>
std::string report_headings(const std::vector<ReportColumn<Row>>& columns) {
  std::string html;
  for (const ReportColumn<Row>& column : columns) html += report_heading(column.title, column.unit);
  return html;
}

template <class Row>
std::string report_rows(const std::vector<ReportColumn<Row>>& columns, const std::vector<Row>& rows) {
  std::string html;
  for (const Row& row : rows) {
    html += "<tr>";
    for (const ReportColumn<Row>& column : columns) html += report_cell(column.cell(row));
    html += "</tr>\n";
  }
  return html;
}

}  // namespace roadstereo::io
