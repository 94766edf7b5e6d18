// Stands in for message_filters of ROS 2 Humble.
#pragma once

#include <string>

#include "rclcpp/rclcpp.hpp"

namespace message_filters {

template <class Message>
class Subscriber {
 public:
  void subscribe(rclcpp::Node* node, const std::string& topic, rmw_qos_profile_t quality);
};

}  // namespace message_filters
