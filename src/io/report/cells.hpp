#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// A cell of a report's table: what it shows, and the number it is sorted by; without one it is sorted by its text.
struct ReportCell {
  std::string html;
  std::optional<double> key{};
};

ReportCell measured_cell(const Measurement& figure);
/// A value with three significant digits.
ReportCell plain_cell(double value);
ReportCell fixed_cell(double value, int decimals);
ReportCell severity_cell(const Damage& damage);

/// What a reader must know of a table whose columns can be sorted.
inline constexpr const char* sorting_hint = "A click on a column's head sorts by it; another turns the order round.";

template <class Row>
struct ReportColumn {
  std::string title;
  std::string unit;
  ReportCell (*cell)(const Row& row);
};

/// A column's head, with the button that sorts by it.
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
