// Stands in for rclcpp_components.
#pragma once

#include <type_traits>

#include "rclcpp/rclcpp.hpp"

#define RCLCPP_COMPONENTS_REGISTER_NODE(Component) \
  static_assert(std::is_constructible_v<Component, rclcpp::NodeOptions>);
