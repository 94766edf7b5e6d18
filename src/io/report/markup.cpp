#include "io/report/markup.hpp"

#include <algorithm>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::string escaped(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  for (const char letter : text) {
    switch (letter) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += letter;
    }
  }
  return html;
}

std::string fill(std::string_view text, const Fields& fields) {
  constexpr std::string_view opening = "{{", closing = "}}";
  std::string filled;
  for (std::size_t at = 0;;) {
    const std::size_t open = text.find(opening, at);
    filled += text.substr(at, open - at);
    if (open == std::string_view::npos) return filled;
    const std::size_t close = text.find(closing, open);
    if (close == std::string_view::npos) fail("a template field is not closed: ", text.substr(open));
    std::string_view name = text.substr(open + opening.size(), close - open - opening.size());
    const bool markup = name.starts_with('&');
    if (markup) name.remove_prefix(1);
    const auto field = fields.find(name);
    if (field == fields.end()) fail("the template field \"", name, "\" has no value");
    filled += markup ? field->second : escaped(field->second);
    at = close + closing.size();
  }
}

std::string damage_link(std::int64_t id, const std::string& content) {
  return "<a href=\"#damage-" + std::to_string(id) + "\">" + content + "</a>";
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = (group << 8U) | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[(group >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

}  // namespace roadstereo::io
