#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "io/source/mcap_records.hpp"
#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Topics are those of the summary; without one (unindexed, cut off), or if it does not repeat the channels or schemas
/// of its messages, the file is read once from its start.
class McapLog final : public MessageLog {
 public:
  explicit McapLog(const std::string& path) : path_(path), file_(path) {
    const std::optional<std::uint64_t> summary = file_.summary_offset();
    if (summary) read_summary(*summary);
    if (!knows_topics()) read_all();
    for (const auto& [id, channel] : channels_) add_topic(channel);
  }

  std::string kind() const override { return cut_off_ ? "MCAP file (cut off)" : "MCAP file"; }
  const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    selected_.clear();
    for (const auto& [id, channel] : channels_) {
      if (std::find(topics.begin(), topics.end(), channel.topic) != topics.end()) selected_.insert(id);
    }
    file_.seek(McapFile::first_offset());
    chunk_.clear();
    rest_ = {};
    next_chunk_ = 0;
  }

  std::optional<LoggedMessage> next() override {
    while (true) {
      while (const std::optional<McapRecord> record = next_record(rest_)) {
        if (record->opcode != McapOpcode::message) continue;
        if (std::optional<LoggedMessage> message = selected_message(record->content)) return message;
      }
      const std::optional<McapRecord> record = next_of_file();
      if (!record || record->opcode == McapOpcode::data_end) return std::nullopt;
      if (record->opcode == McapOpcode::chunk) {
        const std::string error = unpack(record->content);
        if (!error.empty()) return LoggedMessage{{}, 0, {}, error};
      } else if (record->opcode == McapOpcode::message) {
        if (std::optional<LoggedMessage> message = selected_message(record->content)) return message;
      }
    }
  }

 private:
  /// With an index only chunks that have a selected channel, or do not tell, are read.
  std::optional<McapRecord> next_of_file() {
    const auto has_selected = [this](const McapChunkIndex& chunk) {
      return chunk.channels.empty() || std::any_of(selected_.begin(), selected_.end(), [&](std::uint16_t channel) {
               return chunk.channels.contains(channel);
             });
    };
    if (!chunks_.empty()) {
      while (next_chunk_ < chunks_.size() && !has_selected(chunks_[next_chunk_])) ++next_chunk_;
      if (next_chunk_ == chunks_.size()) return std::nullopt;
      file_.seek(chunks_[next_chunk_++].offset);
    }
    return file_.next([](McapOpcode opcode) { return opcode == McapOpcode::chunk || opcode == McapOpcode::message; });
  }

  std::optional<LoggedMessage> selected_message(std::span<const std::uint8_t> content) const {
    McapFields fields(path_, content);
    const auto channel = fields.value<std::uint16_t>();
    if (!selected_.contains(channel)) return std::nullopt;
    fields.value<std::uint32_t>();  // sequence number
    LoggedMessage message;
    message.received_ns = static_cast<std::int64_t>(fields.value<std::uint64_t>());
    fields.value<std::uint64_t>();  // time of publication
    message.topic = channels_.at(channel).topic;
    message.bytes.assign(fields.rest().begin(), fields.rest().end());
    return message;
  }

  /// Unpacks a chunk. Returns why it is lost; the next one may be sound.
  std::string unpack(std::span<const std::uint8_t> content) {
    rest_ = {};
    try {
      chunk_ = read_chunk(path_, content);
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      return error.what();
    }
    rest_ = chunk_;
    return {};
  }

  /// Takes what a record says of topics and chunks.
  void take(const McapRecord& record) {
    switch (record.opcode) {
      case McapOpcode::schema: {
        McapFields fields(path_, record.content);
        const auto id = fields.value<std::uint16_t>();
        schemas_[id] = fields.text();
        break;
      }
      case McapOpcode::channel: {
        const McapChannel channel = read_channel(path_, record.content);
        channels_[channel.id] = channel;
        break;
      }
      case McapOpcode::chunk_index:
        chunks_.push_back(read_chunk_index(path_, record.content));
        break;
      case McapOpcode::statistics: {
        McapFields fields(path_, record.content);
        constexpr std::uint64_t before_counts = 8 + 2 + 4 * sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
        fields.bytes(before_counts);
        counts_ = fields.numbers_by_channel();
        break;
      }
      default:
        break;
    }
  }

  void read_summary(std::uint64_t offset) {
    file_.seek(offset);
    while (const auto record = file_.next([](McapOpcode) { return true; })) {
      if (record->opcode == McapOpcode::footer) break;
      take(*record);
    }
    const auto by_offset = [](const auto& one, const auto& other) { return one.offset < other.offset; };
    std::sort(chunks_.begin(), chunks_.end(), by_offset);
  }

  bool knows_topics() const {
    return !counts_.empty() && std::all_of(counts_.begin(), counts_.end(), [this](const auto& count) {
      const auto channel = channels_.find(count.first);
      return channel != channels_.end() && (channel->second.schema == 0 || schemas_.contains(channel->second.schema));
    });
  }

  void count(const McapRecord& record) {
    if (record.opcode != McapOpcode::message) return take(record);
    ++counts_[McapFields(path_, record.content).value<std::uint16_t>()];
  }

  void read_all() {
    schemas_.clear();
    channels_.clear();
    counts_.clear();
    chunks_.clear();
    file_.seek(McapFile::first_offset());
    while (const auto record = file_.next([](McapOpcode) { return true; })) {
      if (record->opcode == McapOpcode::data_end || record->opcode == McapOpcode::footer) return;
      if (record->opcode != McapOpcode::chunk) {
        count(*record);
        continue;
      }
      unpack(record->content);  // next() tells what is lost
      while (const auto inner = next_record(rest_)) count(*inner);
    }
    cut_off_ = true;
  }

  void add_topic(const McapChannel& channel) {
    const bool cdr = channel.encoding == "cdr";
    if (!cdr && channel.encoding != "ros1") return;
    const auto same = [&](const BagTopic& topic) { return topic.name == channel.topic; };
    const auto messages = static_cast<std::int64_t>(counts_[channel.id]);
    const auto known = std::find_if(topics_.begin(), topics_.end(), same);
    if (known != topics_.end()) {
      known->messages += messages;
    } else {
      topics_.push_back({channel.topic, ros1_type(schemas_[channel.schema]),
                         cdr ? MessageFormat::cdr : MessageFormat::ros1, messages});
    }
  }

  std::string path_;
  McapFile file_;
  bool cut_off_ = false;
  std::map<std::uint16_t, std::string> schemas_;  // names of message types
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::vector<McapChunkIndex> chunks_;
  std::vector<BagTopic> topics_;

  std::set<std::uint16_t> selected_;
  std::size_t next_chunk_ = 0;
  std::vector<std::uint8_t> chunk_;
  std::span<const std::uint8_t> rest_;  // of the chunk
};

}  // namespace

std::unique_ptr<MessageLog> open_mcap_log(const std::string& path) {
  return std::make_unique<McapLog>(path);
}

}  // namespace roadstereo::io
