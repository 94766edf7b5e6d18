// Chunk of an MCAP file: messages, compressed by Zstandard, and their index.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "io/ros/topic.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

inline constexpr std::string_view mcap_compression = "zstd";

/// Returns a chunk of messages and their index. Throws Error for more than `max_decompressed_bytes`, and without a
/// message.
std::vector<std::uint8_t> mcap_chunk(std::span<const TopicMessage> messages);

/// CRC-32 of zlib, as chunks and summary have it.
std::uint32_t mcap_checksum(std::span<const std::uint8_t> bytes);

}  // namespace roadstereo::io
#pragma GCC visibility pop
