#include "io/ros/mcap_chunk.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <map>

#include "io/ros/mcap_bytes.hpp"
#include "io/source/decompress.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::vector<std::uint8_t> zstd_compressed(std::span<const std::uint8_t> bytes) {
  constexpr int fastest = 1;
  std::vector<std::uint8_t> packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), fastest);
  if (ZSTD_isError(size) != 0) fail<SystemError>("zstd cannot compress a chunk: ", ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace

std::uint32_t mcap_checksum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, bytes.data(), bytes.size()));
}

std::vector<std::uint8_t> mcap_chunk(std::span<const TopicMessage> messages) {
  if (messages.empty()) fail("a chunk of an MCAP file needs a message");
  McapBytes records;
  std::map<std::uint16_t, McapBytes> indexes;
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max(), last = 0;
  for (const TopicMessage& message : messages) {
    indexes[message.topic].add(message.time_ns).add(std::uint64_t{records.bytes().size()});
    McapBytes content;
    content.add(message.topic).add(message.sequence).add(message.time_ns).add(message.time_ns);
    content.add(std::span(message.bytes));
    records.add(McapOpcode::message, content);
    first = std::min(first, message.time_ns);
    last = std::max(last, message.time_ns);
  }
  const std::vector<std::uint8_t>& plain = records.bytes();
  if (plain.size() > max_decompressed_bytes) {
    fail("a chunk of an MCAP file has ", plain.size(), " bytes; it can have at most ", max_decompressed_bytes);
  }
  const std::vector<std::uint8_t> packed = zstd_compressed(plain);
  McapBytes content;
  content.add(first).add(last).add(std::uint64_t{plain.size()});
  content.add(mcap_checksum(plain)).add(mcap_compression).add(std::uint64_t{packed.size()}).add(std::span(packed));
  McapBytes chunk;
  chunk.add(McapOpcode::chunk, content);
  for (const auto& [topic, index] : indexes) {
    McapBytes entry;
    entry.add(topic).add(static_cast<std::uint32_t>(index.bytes().size())).add(std::span(index.bytes()));
    chunk.add(McapOpcode::message_index, entry);
  }
  return chunk.bytes();
}

}  // namespace roadstereo::io
