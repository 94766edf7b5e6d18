// Records of MCAP files (mcap.dev/spec): opcode, length, content; little-endian.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadstereo::io {

enum class McapOpcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  summary_offset = 14,
  data_end = 15
};

/// At the start and the end of a file.
inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};
/// Bytes of a record before its content: opcode and length.
inline constexpr std::uint64_t mcap_head_bytes = 9;

/// Fields of a record, one after the other. Throws Error that starts with `source` where the record ends too early.
class McapFields {
 public:
  McapFields(const std::string& source, std::span<const std::uint8_t> rest) : source_(source), rest_(rest) {}

  template <class Value>
  Value value();
  std::string text();
  std::span<const std::uint8_t> bytes(std::uint64_t count);
  /// Map from channels to numbers, preceded by its length in bytes.
  std::map<std::uint16_t, std::uint64_t> numbers_by_channel();
  std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  const std::string& source_;
  std::span<const std::uint8_t> rest_;
};

struct McapRecord {
  McapOpcode opcode{};
  std::span<const std::uint8_t> content;
};

/// Splits the next record off `rest`; nullopt at the end, also where the last record is cut off.
std::optional<McapRecord> next_record(std::span<const std::uint8_t>& rest);

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;
  std::string topic, encoding;
};
McapChannel read_channel(const std::string& source, std::span<const std::uint8_t> content);

/// Messages of a chunk: decompressed records.
std::vector<std::uint8_t> read_chunk(const std::string& source, std::span<const std::uint8_t> content);

/// Chunk of a file and the channels in it.
struct McapChunkIndex {
  std::uint64_t offset = 0;  ///< of its record
  std::map<std::uint16_t, std::uint64_t> channels;
};
McapChunkIndex read_chunk_index(const std::string& source, std::span<const std::uint8_t> content);

/// A file of records.
class McapFile {
 public:
  /// Throws Error unless the file can be read and starts with MCAP's magic.
  explicit McapFile(const std::string& path);

  /// Offset of the first record.
  static std::uint64_t first_offset() { return mcap_magic.size(); }
  /// Offset of the summary at the end; nullopt if the file has none, or is cut off.
  std::optional<std::uint64_t> summary_offset();
  void seek(std::uint64_t offset) { at_ = offset; }

  /// Reads the record at the present offset into the file's buffer. Content of records for which `wanted` is false is
  /// skipped and empty. Returns nullopt at the end, also where the last record is cut off. Throws Error for a record
  /// that is longer than any image.
  template <class Wanted>
  std::optional<McapRecord> next(const Wanted& wanted) {
    std::uint64_t length = 0;
    const std::optional<McapOpcode> opcode = next_head(length);
    if (!opcode) return std::nullopt;
    return McapRecord{*opcode, wanted(*opcode) ? next_content(length) : skip_content(length)};
  }

 private:
  std::optional<McapOpcode> next_head(std::uint64_t& length);
  std::span<const std::uint8_t> next_content(std::uint64_t length);
  std::span<const std::uint8_t> skip_content(std::uint64_t length);

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = first_offset();
  std::vector<std::uint8_t> buffer_;
};

}  // namespace roadstereo::io
