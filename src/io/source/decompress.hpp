// Zstandard and LZ4 frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace roadstereo::io {

/// Largest chunk or message that is decompressed, bytes: twice the largest image.
inline constexpr std::size_t max_decompressed_bytes = std::size_t{1} << 29U;

/// Decompresses frames of Zstandard. Memory grows with what is decompressed, not with what a header promises. Throws
/// Error that starts with `source` for damaged data, and for more than `max_decompressed_bytes`.
std::vector<std::uint8_t> decompress_zstd(const std::string& source, std::span<const std::uint8_t> bytes);

/// Decompresses a file into another, of any size. Throws Error naming the first for damaged data, SystemError if the
/// second cannot be written.
void decompress_zstd_file(const std::string& from, const std::string& to);

/// Decompresses one LZ4 frame, likewise.
std::vector<std::uint8_t> decompress_lz4(const std::string& source, std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::io
