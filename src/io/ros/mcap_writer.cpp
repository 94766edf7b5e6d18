#include "io/ros/mcap_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "io/ros/mcap_bytes.hpp"
#include "io/ros/mcap_chunk.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::io {
namespace {

constexpr std::uint64_t max_record_bytes = std::uint64_t{1} << 62U;  ///< offsets do not overflow

std::vector<std::uint8_t> schema_records(std::span<const RosTopic> topics) {
  McapBytes records;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    McapBytes schema;
    schema.add(static_cast<std::uint16_t>(i + 1)).add(topics[i].type).add("ros2msg").add(topics[i].definition);
    records.add(McapOpcode::schema, schema);
  }
  return records.bytes();
}

std::vector<std::uint8_t> channel_records(std::span<const RosTopic> topics) {
  McapBytes records;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    McapBytes metadata;
    metadata.add("offered_qos_profiles").add("");  // those of ros2 bag play
    McapBytes channel;
    channel.add(static_cast<std::uint16_t>(i)).add(static_cast<std::uint16_t>(i + 1));
    channel.add(topics[i].name).add("cdr");
    channel.add(static_cast<std::uint32_t>(metadata.bytes().size())).add(std::span(metadata.bytes()));
    records.add(McapOpcode::channel, channel);
  }
  return records.bytes();
}

std::span<const std::uint8_t> magic_record() {
  return {reinterpret_cast<const std::uint8_t*>(mcap_magic.data()), mcap_magic.size()};
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, std::span<const RosTopic> topics, int flags)
    : file_(file.string()),
      topics_(static_cast<std::uint16_t>(topics.size())),
      schemas_(schema_records(topics)),
      channels_(channel_records(topics)) {
  constexpr mode_t readable = 0644;
  descriptor_ = ::open(file.c_str(), flags | O_RDWR | O_CLOEXEC, readable);
  if (descriptor_ < 0) fail<SystemError>("cannot write ", file_, ": ", std::generic_category().message(errno));
}

/// Begins every file.
std::vector<std::uint8_t> McapWriter::head() const {
  McapBytes file;
  file.add(magic_record()).add(McapOpcode::header, McapBytes().add("ros2").add(std::string("roadstereo ") + version));
  return file.add(std::span(schemas_)).add(std::span(channels_)).bytes();
}

McapWriter McapWriter::begin(const std::filesystem::path& file, std::span<const RosTopic> topics) {
  McapWriter writer(file, topics, O_CREAT | O_TRUNC);
  writer.write(writer.head());
  return writer;
}

McapWriter McapWriter::resume(const std::filesystem::path& file, std::span<const RosTopic> topics,
                              std::int64_t chunks) {
  if (!std::filesystem::exists(file)) fail(file.string(), ": the file is missing; start again without --resume");
  McapWriter writer(file, topics, 0);
  const std::vector<std::uint8_t> head = writer.head();
  if (writer.read(0, head.size()) != head) {
    fail(file.string(), ": this file is not the one that the flight has begun; start again without --resume");
  }
  writer.end_ = head.size();
  for (std::int64_t i = 0; i < chunks; ++i) {
    if (writer.take_chunk()) continue;
    fail(file.string(), ": the file has ", i, " of the ", chunks,
         " frames that the flight has done; start again without --resume");
  }
  if (::ftruncate(writer.descriptor_, static_cast<off_t>(writer.end_)) != 0) {
    fail<SystemError>("cannot write ", file.string(), ": ", std::generic_category().message(errno));
  }
  return writer;
}

McapWriter::McapWriter(McapWriter&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      topics_(other.topics_),
      schemas_(std::move(other.schemas_)),
      channels_(std::move(other.channels_)),
      end_(other.end_),
      chunks_(std::move(other.chunks_)) {}

McapWriter::~McapWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// Fewer bytes at the end of the file.
std::vector<std::uint8_t> McapWriter::read(std::uint64_t offset, std::size_t count) const {
  std::vector<std::uint8_t> bytes(count);
  std::size_t done = 0;
  while (done < count) {
    const ssize_t part = ::pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(offset + done));
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) fail<SystemError>(file_, " cannot be read: ", std::generic_category().message(errno));
    if (part == 0) break;
    done += static_cast<std::size_t>(part);
  }
  bytes.resize(done);
  return bytes;
}

void McapWriter::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t part = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(end_));
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) fail<SystemError>("cannot write ", file_, ": ", std::generic_category().message(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(part));
    end_ += static_cast<std::uint64_t>(part);
  }
}

/// Takes the chunk at the end of those known, and its message indexes; returns false where it is incomplete.
bool McapWriter::take_chunk() {
  // Head of the record, times, sizes, checksum, name of the compression.
  const std::size_t head_bytes =
      mcap_head_bytes + 4 * sizeof(std::uint64_t) + 2 * sizeof(std::uint32_t) + mcap_compression.size();
  const std::vector<std::uint8_t> head = read(end_, head_bytes);
  if (head.size() < head_bytes || McapOpcode{head[0]} != McapOpcode::chunk) return false;
  McapFields fields(file_, std::span(head).subspan(1));
  Chunk chunk;
  chunk.offset = end_;
  chunk.length = mcap_head_bytes + fields.value<std::uint64_t>();
  chunk.first_ns = fields.value<std::uint64_t>();
  chunk.last_ns = fields.value<std::uint64_t>();
  chunk.bytes = fields.value<std::uint64_t>();
  if (chunk.length < head_bytes || chunk.length > max_record_bytes) return false;
  chunk.packed_bytes = chunk.length - head_bytes;
  const std::uint64_t end = take_message_indexes(chunk);
  if (chunk.message_indexes.empty()) return false;
  end_ = end;
  chunks_.push_back(std::move(chunk));
  return true;
}

/// Returns the end of the last one.
std::uint64_t McapWriter::take_message_indexes(Chunk& chunk) const {
  constexpr std::size_t head_bytes = mcap_head_bytes + sizeof(std::uint16_t) + sizeof(std::uint32_t);
  constexpr std::size_t entry_bytes = 2 * sizeof(std::uint64_t);
  const std::uint64_t begin = chunk.offset + chunk.length;
  std::uint64_t at = begin;
  while (true) {
    const std::vector<std::uint8_t> head = read(at, head_bytes);
    if (head.size() < head_bytes || McapOpcode{head[0]} != McapOpcode::message_index) break;
    McapFields fields(file_, std::span(head).subspan(1));
    const std::uint64_t length = mcap_head_bytes + fields.value<std::uint64_t>();
    if (length < head_bytes || length > max_record_bytes) break;
    const auto topic = fields.value<std::uint16_t>();
    chunk.message_indexes[topic] = at;
    chunk.messages[topic] = fields.value<std::uint32_t>() / entry_bytes;
    at += length;
  }
  chunk.message_index_length = at - begin;
  return at;
}

void McapWriter::append(std::span<const std::uint8_t> chunk) {
  const std::uint64_t begin = end_;
  write(chunk);
  end_ = begin;
  if (!take_chunk()) fail<SystemError>(file_, ": a chunk that was written cannot be read back");
}

void McapWriter::finish() {
  McapBytes summary;
  summary.add(McapOpcode::data_end, McapBytes().add(std::uint32_t{0}));  // without a checksum
  write(summary.bytes());
  const std::uint64_t begin = end_;
  McapBytes statistics, indexes;
  statistics.add(McapOpcode::statistics, statistics_content());
  for (const Chunk& chunk : chunks_) indexes.add(McapOpcode::chunk_index, index_content(chunk));

  McapBytes records, offsets;
  const auto add_group = [&](McapOpcode opcode, std::span<const std::uint8_t> group) {
    if (group.empty()) return;
    McapBytes offset;
    offset.add(static_cast<std::uint8_t>(opcode)).add(begin + records.bytes().size()).add(std::uint64_t{group.size()});
    offsets.add(McapOpcode::summary_offset, offset);
    records.add(group);
  };
  add_group(McapOpcode::schema, schemas_);
  add_group(McapOpcode::channel, channels_);
  add_group(McapOpcode::statistics, statistics.bytes());
  add_group(McapOpcode::chunk_index, indexes.bytes());
  const std::uint64_t offsets_begin = begin + records.bytes().size();
  records.add(std::span(offsets.bytes()));

  // The checksum is that of the summary and of the footer up to it.
  constexpr std::uint64_t footer_bytes = 2 * sizeof(std::uint64_t) + sizeof(std::uint32_t);
  records.add(static_cast<std::uint8_t>(McapOpcode::footer)).add(footer_bytes).add(begin).add(offsets_begin);
  records.add(mcap_checksum(records.bytes())).add(magic_record());
  write(records.bytes());
}

McapBytes McapWriter::statistics_content() const {
  std::map<std::uint16_t, std::uint64_t> messages;
  std::uint64_t all = 0, first_ns = 0, last_ns = 0;
  for (const Chunk& chunk : chunks_) {
    first_ns = &chunk == chunks_.data() ? chunk.first_ns : std::min(first_ns, chunk.first_ns);
    last_ns = std::max(last_ns, chunk.last_ns);
    for (const auto& [topic, count] : chunk.messages) {
      messages[topic] += count;
      all += count;
    }
  }
  constexpr std::uint32_t attachments = 0, metadata = 0;
  McapBytes content;
  content.add(all).add(topics_).add(std::uint32_t{topics_}).add(attachments).add(metadata);
  content.add(static_cast<std::uint32_t>(chunks_.size())).add(first_ns).add(last_ns).add(messages);
  return content;
}

McapBytes McapWriter::index_content(const Chunk& chunk) {
  McapBytes content;
  content.add(chunk.first_ns).add(chunk.last_ns).add(chunk.offset).add(chunk.length).add(chunk.message_indexes);
  content.add(chunk.message_index_length).add(mcap_compression).add(chunk.packed_bytes).add(chunk.bytes);
  return content;
}

}  // namespace roadstereo::io
