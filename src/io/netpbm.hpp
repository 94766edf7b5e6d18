#pragma once

#include <string>

#include "io/image_check.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

bool is_netpbm(Bytes bytes);  ///< PGM or PPM, binary or text
bool is_pfm(Bytes bytes);     ///< portable float map, grey or colour

/// Throws Error naming `path` when a size is outside `least` … `most` pixels.
void check_size(const std::string& path, std::int64_t width, std::int64_t height, int least, int most);

/// Samples of 8 bits are stretched to 0 … 255 when the file's white is lower; samples of 16 bits stay as they
/// are.
Frame read_netpbm(const std::string& path, Bytes bytes);

/// Not finite becomes NaN. Both byte orders; the scale factor's size says nothing and is ignored.
Image<float> read_pfm(const std::string& path, Bytes bytes);

}  // namespace roadstereo::io
