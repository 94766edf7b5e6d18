// Stands in for message_filters of ROS 2 Humble.
#pragma once

#include <cstdint>
#include <memory>

namespace message_filters::sync_policies {

template <class... Messages>
struct ApproximateTime {
  explicit ApproximateTime(std::uint32_t queue_size);

  /// Takes what can be called with a pointer to a message of each kind.
  template <class Callback>
  static void require_callback(const Callback& callback) {
    callback(std::shared_ptr<const Messages>()...);
  }
};

}  // namespace message_filters::sync_policies
