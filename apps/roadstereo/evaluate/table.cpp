#include "evaluate/table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

/// Number of UTF-8 characters.
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right_aligned) {
  const std::string space(width - std::min(width, length(text)), ' ');
  return right_aligned ? space + text : text + space;
}

/// Line without trailing spaces.
std::string line(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

}  // namespace

std::string Cell::text() const {
  if (!is_number_) return text_;
  if (std::isinf(value_)) return value_ > 0 ? "∞" : "−∞";
  return std::isnan(value_) ? "–" : fmt::format("{:.{}f}", value_, decimals_);
}

nlohmann::ordered_json Cell::json() const {
  return is_number_ ? json_number(value_) : nlohmann::ordered_json(text_);
}

std::string Table::text() const {
  std::vector<std::size_t> widths;
  std::vector<bool> numbers(columns.size(), false);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    widths.push_back(length(columns[i].heading));
    for (const auto& row : rows) {
      widths[i] = std::max(widths[i], length(row[i].text()));
      numbers[i] = numbers[i] || row[i].is_number();
    }
  }
  std::string heading = "  ", body;
  for (std::size_t i = 0; i < columns.size(); ++i) heading += padded(columns[i].heading, widths[i], numbers[i]) + "  ";
  for (const auto& row : rows) {
    std::string cells = "  ";
    for (std::size_t i = 0; i < columns.size(); ++i) cells += padded(row[i].text(), widths[i], numbers[i]) + "  ";
    body += line(cells);
  }
  return (title.empty() ? "" : title + "\n") + line(heading) + body;
}

nlohmann::ordered_json Table::json() const {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    nlohmann::ordered_json object;
    for (std::size_t i = 0; i < columns.size(); ++i) object[columns[i].key] = row[i].json();
    array.push_back(object);
  }
  return array;
}

}  // namespace roadstereo::cli
