#pragma once

#include <string_view>

/// Fonts, embedded from this folder at build time.
namespace roadstereo::io::fonts {

extern const std::string_view sans;  ///< DejaVuSans.ttf: ASCII, signs of units and of mathematics

}  // namespace roadstereo::io::fonts
