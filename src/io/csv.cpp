#include "io/csv.hpp"

#include <cmath>
#include <utility>

#include "core/shortest_text.hpp"
#include "io/fixed_text.hpp"

namespace roadstereo::io {

CsvLine& CsvLine::add(std::string_view text) {
  const bool quoted = text.find_first_of(",\"\r\n") != std::string_view::npos;
  if (quoted) text_ += '"';
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) text_ += '\'';
  for (const char letter : text) {
    if (letter == '"') text_ += '"';
    text_ += letter;
  }
  text_ += quoted ? "\"," : ",";
  return *this;
}

CsvLine& CsvLine::add(std::int64_t value) {
  text_ += std::to_string(value) + ",";
  return *this;
}

CsvLine& CsvLine::add(bool value) {
  text_ += value ? "true," : "false,";
  return *this;
}

CsvLine& CsvLine::add(double value) {
  if (!std::isfinite(value)) return add_nothing();
  text_ += shortest_text(value) + ',';
  return *this;
}

CsvLine& CsvLine::add(double value, int decimals) {
  if (!std::isfinite(value)) return add_nothing();
  text_ += fixed_text(value, decimals) + ',';
  return *this;
}

CsvLine& CsvLine::add_nothing() {
  text_ += ',';
  return *this;
}

std::string CsvLine::end() {
  text_.back() = '\r';  // replaces the last comma
  text_ += '\n';
  return std::exchange(text_, {});
}

}  // namespace roadstereo::io
