#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace roadstereo::io {

inline constexpr std::string_view white_space = " \t\r\n\v\f";

/// The text without `letters` at its ends.
inline std::string_view trimmed(std::string_view text, std::string_view letters = white_space) {
  const std::size_t first = text.find_first_not_of(letters);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(letters) - first + 1);
}

inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return lower;
}

}  // namespace roadstereo::io
