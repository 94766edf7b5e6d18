#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "roadstereo/measurement.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Builds a line of RFC 4180 CSV.
class CsvLine {
 public:
  /// Adds a text, quoted if it contains a comma, a quote or a line end. An apostrophe is put before what spreadsheets
  /// would take for a formula: a text that begins with =, +, −, @, a tab or a carriage return.
  CsvLine& add(std::string_view text);
  CsvLine& add(const char* text) { return add(std::string_view(text)); }
  CsvLine& add(std::int64_t value);
  template <std::integral Integer>
  CsvLine& add(Integer value) {
    return add(static_cast<std::int64_t>(value));
  }
  CsvLine& add(bool value);
  /// Adds a number with the fewest digits that are read back as the same number; empty if it is not finite.
  CsvLine& add(double value);
  /// Adds a number with `decimals` decimals.
  CsvLine& add(double value, int decimals);
  /// Adds a value and its standard error.
  CsvLine& add(const Measurement& measured, int decimals) {
    return add(measured.value, decimals).add(measured.std_error, decimals);
  }
  CsvLine& add_nothing();

  std::string end();

 private:
  std::string text_;
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
