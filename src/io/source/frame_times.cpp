#include "io/source/frame_times.hpp"

#include <time.h>  // timegm is POSIX

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "io/geo/utc_time.hpp"
#include "io/plain_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

bool is_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::optional<double> whole_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Parses "2011-09-26 13:02:25.964389445", also with a T.
std::optional<double> date_time(const std::string& text) {
  tm date{};
  const char* rest = ::strptime(text.c_str(), "%Y-%m-%d", &date);
  if (rest == nullptr || (*rest != ' ' && *rest != 'T')) return std::nullopt;
  rest = ::strptime(rest + 1, "%H:%M:%S", &date);
  if (rest == nullptr) return std::nullopt;
  std::string fraction = rest;
  if (!fraction.empty() && fraction.back() == 'Z') fraction.pop_back();
  if (!fraction.empty() && fraction[0] != '.') return std::nullopt;
  const auto part = fraction.empty() ? std::optional(0.0) : whole_number("0" + fraction);
  if (!part) return std::nullopt;
  return static_cast<double>(::timegm(&date)) + *part;
}

}  // namespace

std::optional<double> time_of_name(const std::string& stem) {
  constexpr std::size_t digits_of_seconds = 10;
  const auto point = stem.find('.');
  if (point == digits_of_seconds && is_digits(stem.substr(0, point)) && is_digits(stem.substr(point + 1))) {
    return whole_number(stem);
  }
  if (!is_digits(stem)) return std::nullopt;
  const std::size_t decimals = stem.size() - std::min(stem.size(), digits_of_seconds);
  if (decimals != 3 && decimals != 6 && decimals != 9) return std::nullopt;
  return whole_number(stem.substr(0, digits_of_seconds) + "." + stem.substr(digits_of_seconds));
}

void require_seconds(const std::string& where, const std::string& text, double time_s) {
  if (time_s > latest_unix_s) fail(where, ": ", text, " is after the year 2100; times are seconds, not nanoseconds");
}

std::vector<double> read_times(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) fail(file.string(), ": cannot be read");
  std::vector<double> times;
  std::string line;
  bool text_ends_line = true;
  for (int number = 1; std::getline(stream, line); ++number) {
    text_ends_line = !stream.eof();
    const std::string text(trimmed(line));
    if (text.empty() || text[0] == '#') continue;
    const auto seconds = whole_number(text);
    const auto time = seconds ? seconds : date_time(text);
    if (!time) {
      fail(file.string(), ", line ", number, ": \"", text,
           "\" is not a time; it must be seconds or YYYY-MM-DD hh:mm:ss.fff");
    }
    require_seconds(file.string() + ", line " + std::to_string(number), text, *time);
    times.push_back(*time);
  }
  // After a power cut the last line may be torn: its time lies before the one above.
  const bool is_torn = !text_ends_line && times.size() > 1 && times.back() < times[times.size() - 2];
  if (is_torn) times.pop_back();
  // One time that cannot be costs its pair only.
  std::size_t steps_back = 0, last = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] >= times[i - 1]) continue;
    ++steps_back;
    last = i;
  }
  if (steps_back > 1) {
    fail(file.string(), ": the times must not run backwards, but ", steps_back, " lie before the one above, time ",
         last + 1, " for example");
  }
  return times;
}

}  // namespace roadstereo::io
