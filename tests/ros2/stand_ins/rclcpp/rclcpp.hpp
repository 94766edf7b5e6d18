// Stands in for rclcpp, which Debian does not have: the declarations of ROS 2 Humble that the node uses, for a check of
// its syntax and types. Nothing runs.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

struct rmw_qos_profile_t {};

namespace rclcpp {

class QoS {
 public:
  explicit QoS(std::size_t depth);
  rmw_qos_profile_t& get_rmw_qos_profile();
};

class SensorDataQoS : public QoS {
 public:
  SensorDataQoS();
};

class NodeOptions {};
class Logger {};
class Clock {
 public:
  using SharedPtr = std::shared_ptr<Clock>;
};

template <class Message>
class Publisher {
 public:
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message& message);
  std::size_t get_subscription_count() const;
};

class Node {
 public:
  Node(const std::string& name, const NodeOptions& options);
  virtual ~Node();
  template <class Value>
  auto declare_parameter(const std::string& name, const Value& value) -> Value;
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string& topic, const QoS& quality);
  Logger get_logger() const;
  Clock::SharedPtr get_clock();
};

void log_throttled(const Logger& logger, Clock& clock, int every_ms, const char* format, ...);

}  // namespace rclcpp

#define RCLCPP_WARN_THROTTLE(logger, clock, every_ms, ...) rclcpp::log_throttled(logger, clock, every_ms, __VA_ARGS__)
