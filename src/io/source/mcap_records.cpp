#include "io/source/mcap_records.hpp"

#include <zlib.h>

#include <cstring>
#include <filesystem>

#include "io/source/decompress.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::uint64_t head_bytes = mcap_head_bytes;
constexpr std::uint64_t magic_bytes = mcap_magic.size();
constexpr std::uint64_t footer_bytes = 20;

template <class Value>
Value value_at(const std::uint8_t* bytes) {
  Value value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace

template <class Value>
Value McapFields::value() {
  return value_at<Value>(bytes(sizeof(Value)).data());
}
template std::uint16_t McapFields::value();
template std::uint32_t McapFields::value();
template std::uint64_t McapFields::value();

std::string McapFields::text() {
  const auto letters = bytes(value<std::uint32_t>());
  return {letters.begin(), letters.end()};
}

std::span<const std::uint8_t> McapFields::bytes(std::uint64_t count) {
  if (count > rest_.size()) fail(source_, ": a record of the MCAP file ends too early");
  const auto taken = rest_.first(static_cast<std::size_t>(count));
  rest_ = rest_.subspan(static_cast<std::size_t>(count));
  return taken;
}

std::map<std::uint16_t, std::uint64_t> McapFields::numbers_by_channel() {
  McapFields entries(source_, bytes(value<std::uint32_t>()));
  std::map<std::uint16_t, std::uint64_t> numbers;
  while (!entries.rest().empty()) {
    const auto channel = entries.value<std::uint16_t>();
    numbers[channel] = entries.value<std::uint64_t>();
  }
  return numbers;
}

std::optional<McapRecord> next_record(std::span<const std::uint8_t>& rest) {
  if (rest.size() < head_bytes) return std::nullopt;
  const auto length = value_at<std::uint64_t>(rest.data() + 1);
  if (length > rest.size() - head_bytes) return std::nullopt;
  const McapRecord record{McapOpcode{rest[0]}, rest.subspan(head_bytes, static_cast<std::size_t>(length))};
  rest = rest.subspan(static_cast<std::size_t>(head_bytes + length));
  return record;
}

McapChannel read_channel(const std::string& source, std::span<const std::uint8_t> content) {
  McapFields fields(source, content);
  McapChannel channel;
  channel.id = fields.value<std::uint16_t>();
  channel.schema = fields.value<std::uint16_t>();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  return channel;
}

std::vector<std::uint8_t> read_chunk(const std::string& source, std::span<const std::uint8_t> content) {
  McapFields fields(source, content);
  fields.bytes(2 * sizeof(std::uint64_t));  // first and last time
  const auto size = fields.value<std::uint64_t>();
  const auto crc = fields.value<std::uint32_t>();
  const std::string compression = fields.text();
  const auto packed = fields.bytes(fields.value<std::uint64_t>());
  std::vector<std::uint8_t> records;
  if (compression == "zstd") {
    records = decompress_zstd(source, packed);
  } else if (compression == "lz4") {
    records = decompress_lz4(source, packed);
  } else if (compression.empty()) {
    records.assign(packed.begin(), packed.end());
  } else {
    fail(source, ": a chunk is compressed by \"", compression, "\"; supported are zstd and lz4");
  }
  if (records.size() != size) fail(source, ": a chunk has ", records.size(), " bytes; its header says ", size);
  if (crc != 0 && crc != ::crc32_z(0, records.data(), records.size())) {
    fail(source, ": the checksum of a chunk is wrong; the file is damaged");
  }
  return records;
}

McapChunkIndex read_chunk_index(const std::string& source, std::span<const std::uint8_t> content) {
  McapFields fields(source, content);
  fields.bytes(2 * sizeof(std::uint64_t));  // first and last time
  McapChunkIndex index;
  index.offset = fields.value<std::uint64_t>();
  fields.value<std::uint64_t>();  // length of the chunk
  index.channels = fields.numbers_by_channel();
  return index;
}

McapFile::McapFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) fail(path, ": the file cannot be read");
  size_ = std::filesystem::file_size(path);
  char magic[magic_bytes] = {};
  file_.read(magic, sizeof magic);
  if (std::string_view(magic, sizeof magic) != mcap_magic) fail(path, ": this is not an MCAP file");
}

std::optional<std::uint64_t> McapFile::summary_offset() {
  if (size_ < first_offset() + head_bytes + footer_bytes + magic_bytes) return std::nullopt;
  seek(size_ - magic_bytes - footer_bytes - head_bytes);
  const auto record = next([](McapOpcode opcode) { return opcode == McapOpcode::footer; });
  if (!record || record->opcode != McapOpcode::footer || record->content.size() != footer_bytes) return std::nullopt;
  const auto offset = value_at<std::uint64_t>(record->content.data());
  if (offset < first_offset() || offset >= size_) return std::nullopt;
  return offset;
}

std::optional<McapOpcode> McapFile::next_head(std::uint64_t& length) {
  std::uint8_t head[head_bytes] = {};
  if (at_ + head_bytes > size_) return std::nullopt;
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(at_));
  if (!file_.read(reinterpret_cast<char*>(head), sizeof head)) return std::nullopt;
  length = value_at<std::uint64_t>(head + 1);
  if (length > size_ - at_ - head_bytes) return std::nullopt;
  at_ += head_bytes;
  return McapOpcode{head[0]};
}

std::span<const std::uint8_t> McapFile::next_content(std::uint64_t length) {
  if (length > max_decompressed_bytes) {
    fail(path_, ": a record has ", length, " bytes; it must have at most ", max_decompressed_bytes);
  }
  buffer_.resize(static_cast<std::size_t>(length));
  file_.read(reinterpret_cast<char*>(buffer_.data()), static_cast<std::streamsize>(length));
  if (!file_) throw SystemError(path_ + ": the file cannot be read to its end");
  at_ += length;
  return buffer_;
}

std::span<const std::uint8_t> McapFile::skip_content(std::uint64_t length) {
  at_ += length;
  return {};
}

}  // namespace roadstereo::io
