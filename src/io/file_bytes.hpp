#pragma once

#include <cstdint>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Reads a whole file. Throws Error naming it if it is missing, not a regular file, unreadable, empty, or larger than
/// `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, std::size_t max_bytes);

/// Reads a text file, without its byte order mark. Throws Error like `read_file`, and "this is `is_not`" if it has a
/// zero byte.
std::string read_text(const std::string& path, std::size_t max_bytes, const char* is_not);

}  // namespace roadstereo::io
#pragma GCC visibility pop
