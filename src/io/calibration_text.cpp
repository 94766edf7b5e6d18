#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/calibration_formats.hpp"
#include "io/plain_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// from_chars accepts neither YAML's .nan and .inf nor a leading plus.
std::string_view plain_number(std::string_view text) {
  if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
  if (text.size() > 1 && text.front() == '.' && (text[1] < '0' || text[1] > '9')) text.remove_prefix(1);
  return text;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t max_shown = 40;
  return std::string(text.substr(0, max_shown)) + (text.size() > max_shown ? "…" : "");
}

}  // namespace

double parse_number(const std::string& path, const std::string& key, std::string_view text) {
  const std::string_view number = plain_number(trimmed(text));
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  const bool minus_infinity = number == "-.inf" || number == "-.Inf";
  if (minus_infinity || (error == std::errc{} && !std::isfinite(value)) || error == std::errc::result_out_of_range) {
    fail(path, ": ", key, " is ", trimmed(text), "; it must be a finite number");
  }
  if (error != std::errc{} || end != number.data() + number.size()) {
    fail(path, ": ", key, " is \"", shortened(trimmed(text)), "\"; it must be a number");
  }
  return value;
}

int parse_side(const std::string& path, const std::string& key, std::string_view text) {
  return image_side(path, key, parse_number(path, key, text));
}

int image_side(const std::string& path, const std::string& key, double side) {
  constexpr double max_side = 65535;
  if (side < 1 || side > max_side || side != std::floor(side)) {
    fail(path, ": ", key, " is ", side, "; it must be a whole number of pixels from 1 to ", max_side);
  }
  return static_cast<int>(side);
}

std::vector<std::string_view> split_words(std::string_view text, std::string_view separators) {
  const std::string stops = std::string(white_space) + std::string(separators);
  std::vector<std::string_view> words;
  std::size_t at = text.find_first_not_of(stops);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(stops, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(stops, end);
  }
  return words;
}

std::vector<KeyLine> key_lines(std::string_view text, char separator) {
  std::vector<KeyLine> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t middle = line.find(separator);
    if (middle != std::string_view::npos) {
      lines.push_back({trimmed(line.substr(0, middle)), trimmed(line.substr(middle + 1))});
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

const KeyLine* find_key(const std::vector<KeyLine>& lines, std::string_view key) {
  const auto found = std::find_if(lines.begin(), lines.end(), [&](const KeyLine& line) { return line.key == key; });
  return found == lines.end() ? nullptr : &*found;
}

}  // namespace roadstereo::io
