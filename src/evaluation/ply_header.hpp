#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace roadstereo::io {

enum class PlyEncoding { ascii, little_endian, big_endian };

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

/// Returns the number of bytes of a value in a binary file.
std::size_t size_of(PlyType type);

/// One value per element, or a list: its length and values.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  bool is_list = false;
  PlyType count_type = PlyType::u8;  ///< type of the length of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< according to the header
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;  ///< in the order of the file
  std::size_t bytes = 0;             ///< size of the header
};

/// Parses the header. Throws Error naming `path` and the error.
PlyHeader read_ply_header(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::io
