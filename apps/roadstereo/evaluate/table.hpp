#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadstereo::cli {

/// Cell of a table: text, or a number with its number of decimals. NaN is printed as "–"; both it and infinity are null
/// in JSON.
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

/// Column of a table.
struct Column {
  std::string heading;
  std::string key;  ///< in JSON
};

/// Table for the terminal and for JSON.
struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;

  /// Aligned text; numbers are right-aligned.
  std::string text() const;
  /// Array with one object per row.
  nlohmann::ordered_json json() const;
};

}  // namespace roadstereo::cli
