// Recordings of ROS messages: one interface for bags of ROS 1, rosbag2 and MCAP.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/source/bag_message.hpp"
#include "io/source/bag_topics.hpp"

namespace roadstereo::io {

/// A serialised message and its time of reception.
struct LoggedMessage {
  std::string topic;
  std::int64_t received_ns = 0;  ///< since 1970
  std::vector<std::uint8_t> bytes;
  std::string error{};  ///< why this message, or a chunk of messages, cannot be read; empty if it can
};

/// A recording. Messages are read one by one, about in the order of reception; memory use is that of a chunk.
class MessageLog {
 public:
  MessageLog() = default;
  MessageLog(const MessageLog&) = delete;
  MessageLog& operator=(const MessageLog&) = delete;
  virtual ~MessageLog() = default;

  /// What it is, e.g. "ROS bag".
  virtual std::string kind() const = 0;
  /// Every topic once, with the number of its messages.
  virtual const std::vector<BagTopic>& topics() const = 0;
  /// Starts anew with the messages of these topics.
  virtual void select(const std::vector<std::string>& topics) = 0;
  /// Returns the next selected message, or nullopt at the end. Throws Error naming the file if it is damaged so that
  /// nothing more can be read.
  virtual std::optional<LoggedMessage> next() = 0;
};

/// Returns whether the file or folder is a bag, by its first bytes, or its metadata.yaml.
bool is_message_log(const std::string& path);

/// Opens a bag: ROS 1 (.bag), a folder of rosbag2, or one of its files (.db3, .mcap). Throws Error.
std::unique_ptr<MessageLog> open_message_log(const std::string& path);

// One opener per kind.
std::unique_ptr<MessageLog> open_ros1_log(const std::string& path);
std::unique_ptr<MessageLog> open_sqlite_log(const std::string& path);
std::unique_ptr<MessageLog> open_mcap_log(const std::string& path);
/// Folder with metadata.yaml: the files that it lists, one after the other; each may be compressed by zstd, as a whole
/// or message by message.
std::unique_ptr<MessageLog> open_rosbag2_folder(const std::string& path);

}  // namespace roadstereo::io
