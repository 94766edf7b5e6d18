#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace roadstereo::io {

/// Serialisation of messages.
enum class MessageFormat { ros1, cdr };

/// A topic of a ROS bag.
struct BagTopic {
  std::string name;  ///< "/stereo/left/image_raw"
  std::string type;  ///< "sensor_msgs/Image", also of ROS 2
  MessageFormat format = MessageFormat::ros1;
  std::int64_t messages = 0;
};

/// Returns the name of a message type as ROS 1 spells it: "sensor_msgs/msg/Image" is "sensor_msgs/Image".
std::string ros1_type(std::string type);

/// Returns whether the topic has images: sensor_msgs/Image or sensor_msgs/CompressedImage.
bool is_image_topic(const BagTopic& topic);

/// Selects the left and the right image topic: `wanted` if it names two, else the only pair recognised by name (left
/// and right, cam0 and cam1, image_0 and image_1, …). Raw topics are preferred to compressed ones. Throws Error that
/// starts with `source` and lists the image topics.
std::pair<BagTopic, BagTopic> find_image_topics(const std::string& source, const std::vector<BagTopic>& topics,
                                                const std::vector<std::string>& wanted);

/// Returns the topic with the calibration of the same camera, e.g. "/stereo/left/camera_info".
std::string camera_info_topic(const std::string& image_topic);

}  // namespace roadstereo::io
