#pragma once

#include <string>

#include "io/image_check.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

bool is_netpbm(Bytes bytes);  ///< PGM or PPM, binary or text
bool is_pfm(Bytes bytes);     ///< portable float map, grey or colour

/// Throws Error naming `path` if a side is outside `min_side` … `max_side` pixels.
void check_size(const std::string& path, std::int64_t width, std::int64_t height, int min_side, int max_side);

/// Decodes PGM or PPM. 8-bit samples are scaled to 0 … 255 if the maximum value of the file is lower; 16-bit samples
/// are unchanged.
Frame read_netpbm(const std::string& path, Bytes bytes);

/// Decodes PFM in either byte order; infinity becomes NaN. The magnitude of the scale factor is ignored.
Image<float> read_pfm(const std::string& path, Bytes bytes);

}  // namespace roadstereo::io
