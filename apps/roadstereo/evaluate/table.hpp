#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadstereo::cli {

/// One cell of a table: text, or a number with the decimals it is shown with. NaN is shown as "–", and null in JSON.
class Cell {
 public:
  Cell(std::string text) : text_(std::move(text)) {}
  Cell(const char* text) : text_(text) {}
  Cell(double value, int decimals) : value_(value), decimals_(decimals), is_number_(true) {}

  bool is_number() const { return is_number_; }
  std::string text() const;
  nlohmann::ordered_json json() const;

 private:
  std::string text_;
  double value_ = 0;
  int decimals_ = 0;
  bool is_number_ = false;
};

/// A column: its heading on the terminal and its key in JSON.
struct Column {
  std::string heading;
  std::string key;
};

/// A small table for the terminal, and the same rows as JSON.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;

  /// Columns as wide as their longest cell; text to the left, numbers to the right.
  std::string text() const;
  /// An array with one object per row.
  nlohmann::ordered_json json() const;
};

}  // namespace roadstereo::cli
