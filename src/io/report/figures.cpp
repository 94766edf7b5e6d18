#include "io/report/figures.hpp"

#include <algorithm>
#include <cmath>

#include "io/drawing.hpp"

namespace roadstereo::io {
namespace {

/// Place of the first digit: 2 for hundreds, −1 for tenths.
int first_place(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

/// Decimals that show the value with that many significant digits.
int decimals_for(double value, int digits) {
  constexpr int most = 6;
  if (value == 0 || !std::isfinite(value)) return 0;
  return std::clamp(digits - 1 - first_place(value), 0, most);
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + "\u00a0" + unit;
}

}  // namespace

std::string value_text(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  return with_unit(number_text(value, decimals_for(value, 3)), unit);
}

std::string measured_text(const Measurement& figure, const std::string& unit) {
  const double error = figure.std_error;
  if (!std::isfinite(figure.value) || !(error > 0) || !std::isfinite(error)) return value_text(figure.value, unit);
  const bool small_first_digit = error / std::pow(10.0, first_place(error)) < 3;
  constexpr int max_digits = 5;  // of the value: more are not read
  const int most = figure.value == 0 ? max_digits : decimals_for(figure.value, max_digits);
  const int decimals = std::min(decimals_for(error, small_first_digit ? 2 : 1), most);
  return with_unit(number_text(figure.value, decimals) + "\u00a0±\u00a0" + number_text(error, decimals), unit);
}

Measurement scaled(const Measurement& figure, double factor) {
  return {figure.value * factor, figure.std_error * factor};
}

}  // namespace roadstereo::io
