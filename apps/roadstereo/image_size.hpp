#pragma once

#include <string>

#include "core/require_size.hpp"

namespace roadstereo::cli {

/// Parses "640x360", the argument of an option. Throws Error naming the option if it is not two positive numbers.
ImageSize parse_image_size(const std::string& option, const std::string& text);

}  // namespace roadstereo::cli
