#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// One column of a bar table: a lying bar with its number for every row.
struct BarColumn {
  std::string title;  ///< with the unit
  std::vector<double> values;
  int decimals = 2;
};

/// Rows by name, and some figures of each that have scales of their own.
struct BarTable {
  std::string title;
  std::vector<std::string> rows;
  std::vector<std::size_t> bases;  ///< of each row, the row that it is compared with
  std::vector<BarColumn> columns;
};

/// Draws the table; the rows that share a base share a scale. A bar is blue where its row is its own base, green where
/// it is shorter than its base, orange where it is longer, grey where they differ by 3 % or less; NaN has none. A bar
/// more than three times as long as its base is cut off and has a slit before its end. Throws Error when there is no
/// row or a column has another number of values.
Frame draw_bar_table(const BarTable& table);

}  // namespace roadstereo::io
