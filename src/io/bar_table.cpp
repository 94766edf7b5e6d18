#include "roadstereo/io/bar_table.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr int letters = 10;
constexpr int row_height = 2 * letters + 2;
constexpr int heading = 5 * letters;  // title and names of the columns
constexpr int bar_length = 110;
constexpr int gap = 12;

const cv::Scalar base_colour{178, 114, 0}, better_colour{115, 158, 0}, worse_colour{0, 120, 230},
    equal_colour{150, 150, 150};

int name_width(const BarTable& table) {
  int width = 0;
  for (const std::string& name : table.rows) width = std::max(width, text_width(name, letters));
  return width + 2 * gap;
}

int number_width(const BarColumn& column) {
  int width = 0;
  for (const double value : column.values) {
    if (std::isfinite(value)) width = std::max(width, text_width(number_text(value, column.decimals), letters));
  }
  return width + gap / 2;
}

int column_width(const BarColumn& column) {
  return std::max(bar_length + number_width(column), text_width(column.title, letters)) + 2 * gap;
}

void require_consistent(const BarTable& table) {
  const bool consistent = table.bases.size() == table.rows.size() &&
                          std::all_of(table.columns.begin(), table.columns.end(), [&](const BarColumn& column) {
                            return column.values.size() == table.rows.size();
                          });
  if (table.rows.empty() || !consistent) {
    fail("the table \"", table.title, "\" has no row, or not one base and one value of each column for every row");
  }
}

/// The value of a bar of full length among the rows that share a base: no more than three times that.
double full_value(const BarTable& table, const BarColumn& column, std::size_t base) {
  constexpr double max_bases = 3;
  double longest = 1e-9;
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    if (table.bases[i] == base && std::isfinite(column.values[i])) longest = std::max(longest, column.values[i]);
  }
  const double of_base = column.values[base];
  return of_base > 0 ? std::min(longest, max_bases * of_base) : longest;
}

cv::Scalar bar_colour(const BarTable& table, const BarColumn& column, std::size_t row) {
  const std::size_t base = table.bases[row];
  if (base == row) return base_colour;
  const double value = column.values[row], other = column.values[base];
  constexpr double alike = 0.03;
  if (!std::isfinite(other) || number_text(value, column.decimals) == number_text(other, column.decimals) ||
      std::abs(value - other) <= alike * other) {
    return equal_colour;
  }
  return value < other ? better_colour : worse_colour;
}

void draw_bar(cv::Mat& picture, const cv::Rect& bar, bool cut, const cv::Scalar& colour) {
  cv::rectangle(picture, bar, colour, cv::FILLED);
  if (!cut) return;
  constexpr int slit = 4, before_end = 12;
  cv::rectangle(picture, cv::Rect(bar.br().x - before_end, bar.y, slit, bar.height), paper, cv::FILLED);
}

void draw_column(cv::Mat& picture, const BarTable& table, const BarColumn& column, int left) {
  put_text(picture, column.title, {left, heading - letters}, letters, ink);
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    const double value = column.values[i];
    if (!std::isfinite(value)) continue;
    const double full = full_value(table, column, table.bases[i]);
    const int top = heading + row_height * static_cast<int>(i) + 3;
    const int length = std::max(1, cvRound(bar_length * std::clamp(value / full, 0.0, 1.0)));
    draw_bar(picture, {left, top, length, row_height - 6}, value > full, bar_colour(table, column, i));
    put_text(picture, number_text(value, column.decimals), {left + length + gap / 2, top + row_height - letters + 1},
             letters, ink);
  }
}

}  // namespace

Frame draw_bar_table(const BarTable& table) {
  require_consistent(table);
  int width = name_width(table);
  for (const BarColumn& column : table.columns) width += column_width(column);
  width = std::max(width, text_width(table.title, letters + 2) + 2 * gap);
  const int rows = static_cast<int>(table.rows.size());
  cv::Mat picture(heading + row_height * rows + gap, width, CV_8UC3, paper);
  put_text(picture, table.title, {gap, 2 * letters}, letters + 2, ink);
  for (int i = 0; i < rows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const int top = heading + row_height * i;
    if (table.bases[row] == row) cv::line(picture, {0, top}, {width, top}, ink);
    put_text(picture, table.rows[row], {gap, top + row_height - letters / 2 - 1}, letters, ink);
  }
  int left = name_width(table);
  for (const BarColumn& column : table.columns) {
    draw_column(picture, table, column, left);
    left += column_width(column);
  }
  return frame_from(picture, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
