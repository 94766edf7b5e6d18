#include "image_size.hpp"

#include <charconv>
#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {

ImageSize parse_image_size(const std::string& option, const std::string& text) {
  ImageSize size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec == std::errc() && height.ptr == end && size.width > 0 && size.height > 0) return size;
  }
  fail(option, " must be WIDTHxHEIGHT, for example 640x360, but is \"", text, "\"");
}

}  // namespace roadstereo::cli
