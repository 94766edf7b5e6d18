#include <zlib.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "io/image_check.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t chunk_frame = 12;  // length, type and checksum around the data

std::uint32_t checksum(Bytes bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

std::uint32_t big_endian_32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24U | static_cast<std::uint32_t>(bytes[at + 1]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8U | bytes[at + 3];
}

struct Chunk {
  std::string_view type;
  Bytes data;
  Bytes whole;  // with length, type and checksum
};

Chunk next_chunk(const std::string& path, Bytes bytes, std::size_t at) {
  if (bytes.size() - at < chunk_frame) fail(path, ": the PNG file is truncated");
  const std::uint32_t length = big_endian_32(bytes, at);
  if (length > bytes.size() - at - chunk_frame) fail(path, ": the PNG file is truncated");
  const std::size_t size = length;
  const Chunk chunk{{reinterpret_cast<const char*>(bytes.data() + at + 4), 4},
                    bytes.subspan(at + 8, size),
                    bytes.subspan(at, size + chunk_frame)};
  if (checksum(bytes.subspan(at + 4, size + 4)) != big_endian_32(bytes, at + 8 + size)) {
    fail(path, ": the PNG file is damaged: wrong checksum");
  }
  return chunk;
}

int channels_of(int colour_type) {
  switch (colour_type) {
    case 0:
      return 1;
    case 2:
    case 3:
      return 3;
    case 4:
    case 6:
      return 4;
    default:
      return 0;
  }
}

ImageHeader read_header(const std::string& path, const Chunk& chunk) {
  if (chunk.type != "IHDR" || chunk.data.size() != 13) fail(path, ": the PNG file is damaged: it has no header");
  const int bits = chunk.data[8];
  const int colour_type = chunk.data[9];
  const bool grey = colour_type == 0;
  const bool palette = colour_type == 3;
  const bool narrow = bits == 1 || bits == 2 || bits == 4;
  const bool known = channels_of(colour_type) != 0 && chunk.data[10] == 0 && chunk.data[11] == 0 && chunk.data[12] <= 1;
  if (!known || !(bits == 8 || (bits == 16 && !palette) || (narrow && (grey || palette)))) {
    fail(path, ": the PNG file is damaged: its header has impossible values");
  }
  ImageHeader header;
  header.width = big_endian_32(chunk.data, 0);
  header.height = big_endian_32(chunk.data, 4);
  header.bits = palette ? 8 : bits;
  header.channels = channels_of(colour_type);
  return header;
}

bool is_essential(std::string_view type) {
  return type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
}

}  // namespace

bool is_png(Bytes bytes) {
  return bytes.size() >= signature.size() && std::equal(signature.begin(), signature.end(), bytes.begin());
}

ImageHeader check_png(const std::string& path, Bytes bytes, std::vector<std::uint8_t>& essential) {
  essential.assign(signature.begin(), signature.end());
  essential.reserve(bytes.size());
  std::size_t at = signature.size();
  Chunk chunk = next_chunk(path, bytes, at);
  const ImageHeader header = read_header(path, chunk);
  bool has_palette = false;
  bool has_data = false;
  for (;;) {
    has_palette = has_palette || chunk.type == "PLTE";
    has_data = has_data || chunk.type == "IDAT";
    if (is_essential(chunk.type)) essential.insert(essential.end(), chunk.whole.begin(), chunk.whole.end());
    if (chunk.type == "IEND") break;
    at += chunk.whole.size();
    chunk = next_chunk(path, bytes, at);
  }
  constexpr std::size_t colour_type_at = 25;
  if (!has_data || (essential[colour_type_at] == 3 && !has_palette)) {
    fail(path, ": the PNG file is damaged: a chunk is missing");
  }
  return header;
}

}  // namespace roadstereo::io
