#include "io/report/number_text.hpp"

#include <algorithm>
#include <cmath>

#include "io/drawing.hpp"

namespace roadstereo::io {
namespace {

/// Decimal exponent of the first digit: 2 for hundreds, −1 for tenths.
int first_exponent(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

/// Number of decimals for that many significant digits.
int decimals_for(double value, int digits) {
  constexpr int max_decimals = 6;
  if (value == 0 || !std::isfinite(value)) return 0;
  return std::clamp(digits - 1 - first_exponent(value), 0, max_decimals);
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + "\u00a0" + unit;
}

}  // namespace

std::string value_text(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  return with_unit(number_text(value, decimals_for(value, 3)), unit);
}

std::string measured_text(const Measurement& measured, const std::string& unit) {
  const double error = measured.std_error;
  if (!std::isfinite(measured.value) || !(error > 0) || !std::isfinite(error)) return value_text(measured.value, unit);
  const bool small_first_digit = error / std::pow(10.0, first_exponent(error)) < 3;
  constexpr int max_digits = 5;  // of the value
  const int max_decimals = measured.value == 0 ? max_digits : decimals_for(measured.value, max_digits);
  const int decimals = std::min(decimals_for(error, small_first_digit ? 2 : 1), max_decimals);
  return with_unit(number_text(measured.value, decimals) + "\u00a0±\u00a0" + number_text(error, decimals), unit);
}

std::string bound_text(bool is_lower_bound, const std::string& text) {
  return is_lower_bound ? "≥\u00a0" + text : text;
}

Measurement scaled(const Measurement& measured, double factor) {
  return {measured.value * factor, measured.std_error * factor};
}

}  // namespace roadstereo::io
