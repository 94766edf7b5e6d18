// Writer of MCAP files (mcap.dev/spec) of ROS 2 messages: one chunk after the other, compressed by Zstandard, with
// indexes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/ros/topic.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

class McapBytes;

/// A file that grows by chunks. Cut off after a chunk, it can be read without an index, and be resumed: the same chunks
/// give the same bytes. Throws SystemError if it cannot be written.
class McapWriter {
 public:
  /// Creates a file; replaces an existing one.
  static McapWriter begin(const std::filesystem::path& file, std::span<const RosTopic> topics);

  /// Opens an existing file and cuts it off after its first `chunks`. Throws Error naming the file unless it has them
  /// and begins with these topics.
  static McapWriter resume(const std::filesystem::path& file, std::span<const RosTopic> topics, std::int64_t chunks);

  McapWriter(McapWriter&& other) noexcept;
  McapWriter& operator=(McapWriter&&) = delete;
  ~McapWriter();

  /// Appends a `mcap_chunk`.
  void append(std::span<const std::uint8_t> chunk);

  /// Writes the summary: topics, statistics and index of the chunks. Call it once, after the last chunk.
  void finish();

 private:
  /// What the summary says of a chunk.
  struct Chunk {
    std::uint64_t first_ns = 0, last_ns = 0;
    std::uint64_t offset = 0, length = 0;                    ///< of its record
    std::map<std::uint16_t, std::uint64_t> message_indexes;  ///< offsets by topic
    std::uint64_t message_index_length = 0;
    std::uint64_t packed_bytes = 0, bytes = 0;
    std::map<std::uint16_t, std::uint64_t> messages;  ///< by topic
  };

  McapWriter(const std::filesystem::path& file, std::span<const RosTopic> topics, int flags);
  std::vector<std::uint8_t> read(std::uint64_t offset, std::size_t count) const;
  void write(std::span<const std::uint8_t> bytes);
  std::vector<std::uint8_t> head() const;
  bool take_chunk();
  std::uint64_t take_message_indexes(Chunk& chunk) const;
  McapBytes statistics_content() const;
  static McapBytes index_content(const Chunk& chunk);

  std::string file_;
  int descriptor_ = -1;
  std::uint16_t topics_;
  std::vector<std::uint8_t> schemas_, channels_;  // records
  std::uint64_t end_ = 0;
  std::vector<Chunk> chunks_;
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
