#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <filesystem>
#include <functional>
#include <set>

#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::vector<std::uint8_t> bytes_of(const rosbag::MessageInstance& message) {
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream stream(bytes.data(), message.size());
  message.write(stream);
  return bytes;
}

void open_for_reading(rosbag::Bag& bag, const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) fail(file, ": the file does not exist, or is not a regular file");
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    fail(file, ": the bag has no index, because the recording was interrupted; rosbag reindex ", file, " creates it");
  } catch (const ros::Exception& error) {
    fail(file, ": this is not a readable ROS 1 bag (", error.what(), "); if it is truncated, rosbag reindex ", file,
         " may repair it");
  }
}

/// Reads messages with rosbag_storage in the order of the recording.
class Ros1Log final : public MessageLog {
 public:
  explicit Ros1Log(const std::string& file) : file_(file) {
    open_for_reading(bag_, file);
    reading([&] { find_topics(); });
  }

  std::string kind() const override { return "ROS bag"; }
  const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    reading([&] {
      messages_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(topics));
      at_ = messages_->begin();
    });
  }

  std::optional<LoggedMessage> next() override {
    if (!messages_) return std::nullopt;
    std::optional<LoggedMessage> message;
    reading([&] {
      if (at_ == messages_->end()) return;
      message = LoggedMessage{at_->getTopic(), static_cast<std::int64_t>(at_->getTime().toNSec()), bytes_of(*at_)};
      ++at_;
    });
    return message;
  }

 private:
  /// Converts exceptions of ROS to Error naming the file.
  void reading(const std::function<void()>& call) const {
    try {
      call();
    } catch (const ros::Exception& error) {
      fail(file_, ": the bag cannot be read: ", error.what(), "; rosbag reindex ", file_, " may repair it");
    }
  }

  void find_topics() {
    rosbag::View all(bag_);
    std::set<std::string> seen;
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      if (!seen.insert(connection->topic).second) continue;
      const auto count = rosbag::View(bag_, rosbag::TopicQuery(connection->topic)).size();
      topics_.push_back({connection->topic, connection->datatype, MessageFormat::ros1, std::int64_t{count}});
    }
  }

  std::string file_;
  rosbag::Bag bag_;
  std::vector<BagTopic> topics_;
  std::unique_ptr<rosbag::View> messages_;
  rosbag::View::iterator at_;
};

}  // namespace

std::unique_ptr<MessageLog> open_ros1_log(const std::string& path) {
  return std::make_unique<Ros1Log>(path);
}

}  // namespace roadstereo::io
