#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace roadstereo::io {

/// A line of RFC 4180: cells between commas, CRLF at the end.
class CsvLine {
 public:
  /// Quoted where it holds a comma, a quote or a line end.
  CsvLine& add(std::string_view text);
  CsvLine& add(const char* text) { return add(std::string_view(text)); }
  CsvLine& add(std::int64_t value);
  CsvLine& add(bool value);
  /// The shortest digits that are read back as the same number; nothing for what is not finite.
  CsvLine& add(double value);
  /// With so many decimals.
  CsvLine& add(double value, int decimals);
  CsvLine& add_nothing();

  std::string end();

 private:
  std::string text_;
};

}  // namespace roadstereo::io
