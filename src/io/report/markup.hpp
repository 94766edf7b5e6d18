#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace roadstereo::io {

/// Escapes text for HTML, also inside quoted attributes.
std::string escaped(std::string_view text);

/// Values of the template fields by name.
using Fields = std::map<std::string, std::string, std::less<>>;

/// Fills a template: replaces `{{name}}` by the escaped value of the field and `{{&name}}` by the unescaped one. Throws
/// Error naming a field without a value.
std::string fill(std::string_view text, const Fields& fields);

/// Returns a link to where the report tells of a damage; `content` is HTML.
std::string damage_link(std::int64_t id, const std::string& content);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::io
