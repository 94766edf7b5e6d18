#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace roadstereo::io {

// The decoders behind OpenCV report damage on stderr, in their own words, and some return a half-grey image.
// So a file's structure is checked first, and they only see files that are whole.

using Bytes = std::span<const std::uint8_t>;

/// What the headers of an image file say.
struct ImageHeader {
  std::int64_t width = 0;
  std::int64_t height = 0;
  int bits = 8;  ///< per sample
  int channels = 1;
  bool is_float = false;
};

bool is_png(Bytes bytes);
bool is_jpeg(Bytes bytes);
bool is_tiff(Bytes bytes);

/// Checks every chunk's length and checksum. Leaves in `essential` the same picture without its ancillary
/// chunks (colour profiles, text, Exif), which only make the decoder talk. Throws Error naming `path`.
ImageHeader check_png(const std::string& path, Bytes bytes, std::vector<std::uint8_t>& essential);

/// Walks the segments to the end-of-image marker. Throws Error naming `path`.
ImageHeader check_jpeg(const std::string& path, Bytes bytes);

/// Checks that the first picture's strips or tiles lie inside the file. Throws Error naming `path`.
ImageHeader check_tiff(const std::string& path, Bytes bytes);

}  // namespace roadstereo::io
