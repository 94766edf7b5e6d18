// Publishes ROS 2 messages by DDS, under the names that ROS 2 gives its topics and types there: rt/TOPIC,
// PACKAGE::msg::dds_::TYPE_.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "io/ros/topic.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Writers of topics in one domain: reliable, volatile, keeping the last message. Not thread-safe.
class DdsPublisher {
 public:
  /// Joins a domain (ROS_DOMAIN_ID), 0 … 230. Throws Error if it cannot be joined, or in a build without DDS.
  DdsPublisher(std::uint32_t domain, std::span<const RosTopic> topics);
  ~DdsPublisher();
  DdsPublisher(const DdsPublisher&) = delete;
  DdsPublisher& operator=(const DdsPublisher&) = delete;

  /// Whether somebody subscribes to one of the topics.
  bool has_subscribers() const;

  /// Publishes messages whose topics are indices of the list; those without a subscriber are skipped, and a message is
  /// dropped when a reader does not keep up. Throws Error for others.
  void publish(std::span<const TopicMessage> messages);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
