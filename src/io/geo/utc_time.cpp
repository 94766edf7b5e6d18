#include "io/geo/utc_time.hpp"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

namespace roadstereo::io {
namespace {

constexpr double first_day_of_1980_s = 315532800;

/// Consumes a text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }

  /// Consumes one letter if it is next.
  bool take(char letter) {
    if (rest_.empty() || rest_.front() != letter) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// Consumes exactly that many digits; -1 if there are fewer.
  int digits(int count) {
    int value = 0;
    for (int i = 0; i < count; ++i) {
      const int digit = take_digit();
      if (digit < 0) return -1;
      value = 10 * value + digit;
    }
    return value;
  }

  /// Consumes the digits after a decimal point, 0 … 1; -1 if there are none.
  double fraction() {
    double value = 0;
    double unit = 1;
    bool any = false;
    for (int digit = take_digit(); digit >= 0; digit = take_digit()) {
      any = true;
      value = 10 * value + digit;
      unit *= 10;
    }
    return any ? value / unit : -1;
  }

 private:
  int take_digit() {
    if (rest_.empty() || rest_.front() < '0' || rest_.front() > '9') return -1;
    const int digit = rest_.front() - '0';
    rest_.remove_prefix(1);
    return digit;
  }

  std::string_view rest_;
};

/// Seconds from 1970 to the start of a day.
std::optional<double> take_date(Scanner& text) {
  const int year = text.digits(4);
  if (year < 0 || !text.take('-')) return std::nullopt;
  const int month = text.digits(2);
  if (month < 0 || !text.take('-')) return std::nullopt;
  const int day = text.digits(2);
  if (day < 0) return std::nullopt;
  const std::chrono::year_month_day date(std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day)));
  if (!date.ok()) return std::nullopt;
  return 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Seconds of the day; 60 is a leap second.
std::optional<double> take_time_of_day(Scanner& text) {
  const int hour = text.digits(2);
  if (hour < 0 || hour > 23 || !text.take(':')) return std::nullopt;
  const int minute = text.digits(2);
  if (minute < 0 || minute > 59) return std::nullopt;
  double second = 0;
  if (text.take(':')) {
    second = text.digits(2);
    if (second < 0 || second > 60) return std::nullopt;
    if (text.take('.') || text.take(',')) {
      const double fraction = text.fraction();
      if (fraction < 0) return std::nullopt;
      second += fraction;
    }
  }
  return 3600.0 * hour + 60.0 * minute + second;
}

/// Seconds of an offset from UTC, after its sign.
std::optional<double> take_offset(Scanner& text) {
  const int hour = text.digits(2);
  if (hour < 0 || hour > 23) return std::nullopt;
  if (text.at_end()) return 3600.0 * hour;
  text.take(':');
  const int minute = text.digits(2);
  if (minute < 0 || minute > 59) return std::nullopt;
  return 3600.0 * hour + 60.0 * minute;
}

/// At least so many digits, whatever the locale.
std::string padded(int value, std::size_t width) {
  const std::string digits = std::to_string(value);
  return std::string(digits.size() < width ? width - digits.size() : 0, '0') + digits;
}

}  // namespace

std::optional<UtcTime> utc_time(double unix_s) {
  if (!(unix_s >= first_day_of_1980_s && unix_s <= latest_unix_s)) return std::nullopt;
  const std::int64_t milliseconds = std::llround(unix_s * 1000);
  constexpr std::int64_t day_ms = 86'400'000;
  const std::int64_t days = milliseconds / day_ms;
  const std::int64_t of_day = milliseconds % day_ms;
  const std::chrono::year_month_day date{std::chrono::sys_days{std::chrono::days{days}}};
  return UtcTime{static_cast<int>(date.year()),
                 static_cast<int>(static_cast<unsigned>(date.month())),
                 static_cast<int>(static_cast<unsigned>(date.day())),
                 static_cast<int>(of_day / 3'600'000),
                 static_cast<int>(of_day / 60'000 % 60),
                 static_cast<int>(of_day % 60'000)};
}

std::string iso_text(const UtcTime& time) {
  return padded(time.year, 4) + '-' + padded(time.month, 2) + '-' + padded(time.day, 2) + 'T' + padded(time.hour, 2) +
         ':' + padded(time.minute, 2) + ':' + padded(time.millisecond / 1000, 2) + '.' +
         padded(time.millisecond % 1000, 3) + 'Z';
}

std::optional<IsoTime> parse_iso_time(std::string_view text) {
  Scanner scanner(text);
  const std::optional<double> day = take_date(scanner);
  if (!day || !(scanner.take('T') || scanner.take('t') || scanner.take(' '))) return std::nullopt;
  const std::optional<double> time = take_time_of_day(scanner);
  if (!time) return std::nullopt;
  IsoTime parsed{*day + *time, !scanner.at_end()};
  if (!parsed.has_zone) return parsed;
  scanner.take(' ');
  if (!scanner.take('Z') && !scanner.take('z')) {
    const bool ahead = scanner.take('+');
    if (!ahead && !scanner.take('-')) return std::nullopt;
    const std::optional<double> offset = take_offset(scanner);
    if (!offset) return std::nullopt;
    parsed.unix_s += ahead ? -*offset : *offset;
  }
  if (!scanner.at_end()) return std::nullopt;
  return parsed;
}

}  // namespace roadstereo::io
