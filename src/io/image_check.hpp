#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace roadstereo::io {

// OpenCV's decoders print errors to stderr, and some return incomplete images. So the structure of a file is checked
// before it is decoded.

using Bytes = std::span<const std::uint8_t>;

/// Header fields of an image file.
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

/// Checks length and checksum of every chunk. Writes the file without ancillary chunks (colour profiles, text, Exif),
/// which cause decoder warnings, to `essential`. Throws Error naming `path`.
ImageHeader check_png(const std::string& path, Bytes bytes, std::vector<std::uint8_t>& essential);

/// Checks all segments up to the end-of-image marker. Throws Error naming `path`.
ImageHeader check_jpeg(const std::string& path, Bytes bytes);

/// Checks that the strips or tiles of the first image are inside the file, and that it is stored upright. Throws Error
/// naming `path`.
ImageHeader check_tiff(const std::string& path, Bytes bytes);

/// Checks that the compressed strips or tiles of the first image can be decoded: OpenCV leaves those black that cannot.
/// Throws Error naming `path`. The size must have been checked.
void check_tiff_decodes(const std::string& path, Bytes bytes);

}  // namespace roadstereo::io
