#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace roadstereo::io {

/// A topic and the type of its messages.
struct RosTopic {
  std::string_view name;
  std::string_view type;        ///< e.g. "sensor_msgs/msg/Image"
  std::string_view definition;  ///< text of the type and of all types in it, as ROS 2 has it ("ros2msg")
};

/// A serialised message.
struct TopicMessage {
  std::uint16_t topic = 0;     ///< index of its topic
  std::uint32_t sequence = 0;  ///< number of the message
  std::uint64_t time_ns = 0;   ///< since 1970
  std::vector<std::uint8_t> bytes;
};

}  // namespace roadstereo::io
