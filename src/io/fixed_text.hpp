#pragma once

#include <array>
#include <charconv>
#include <string>

namespace roadstereo::io {

/// A finite number with so many decimals, whatever the locale.
inline std::string fixed_text(double value, int decimals) {
  std::array<char, 400> text{};  // more than the largest number has
  char* const end = text.data() + text.size();
  return {text.data(), std::to_chars(text.data(), end, value, std::chars_format::fixed, decimals).ptr};
}

}  // namespace roadstereo::io
