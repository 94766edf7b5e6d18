// Stands in for message_filters of ROS 2 Humble.
#pragma once

namespace message_filters {

template <class Policy>
class Synchronizer {
 public:
  template <class... Filters>
  Synchronizer(const Policy& policy, Filters&... filters);
  template <class Callback>
  void registerCallback(const Callback& callback) {
    Policy::require_callback(callback);
  }
};

}  // namespace message_filters
