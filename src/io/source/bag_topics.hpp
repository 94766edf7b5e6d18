#pragma once

#include <string>
#include <utility>
#include <vector>

namespace roadstereo::io {

/// A topic of a ROS bag.
struct BagTopic {
  std::string name;  ///< "/stereo/left/image_raw"
  std::string type;  ///< "sensor_msgs/Image"
};

/// Whether the topic carries pictures: sensor_msgs/Image or sensor_msgs/CompressedImage.
bool is_image_topic(const BagTopic& topic);

/// The left and the right image topic: `wanted`, when it names two, else the only two whose names tell left from right
/// (left and right, cam0 and cam1, image_0 and image_1, …). Of a camera that is there raw and compressed, raw is taken.
/// Throws Error that begins with `source`, lists the image topics and names --topics.
std::pair<BagTopic, BagTopic> find_image_topics(const std::string& source, const std::vector<BagTopic>& topics,
                                                const std::vector<std::string>& wanted);

/// The topic beside it that has the camera's calibration: "/stereo/left/camera_info".
std::string camera_info_topic(const std::string& image_topic);

}  // namespace roadstereo::io
