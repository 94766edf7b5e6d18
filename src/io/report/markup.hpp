#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace roadstereo::io {

/// Text as HTML shows it, also inside quoted attributes.
std::string escaped(std::string_view text);

/// What stands in a template's places, by name.
using Fields = std::map<std::string, std::string, std::less<>>;

/// The template with `{{name}}` replaced by the field's text, escaped, and `{{&name}}` by the field as it is. Throws
/// Error naming a place that has no field.
std::string fill(std::string_view text, const Fields& fields);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::io
