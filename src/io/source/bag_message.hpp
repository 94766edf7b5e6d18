#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/camera_info.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

// Messages of ROS 1 as they are serialised: little-endian, lists and texts with their length before them. Read here,
// since ROS's own headers of them do not compile as C++20.

/// The time in the header that the message begins with, nanoseconds; 0 when it has none. Throws Error.
std::int64_t stamp_ns(const std::string& source, const std::vector<std::uint8_t>& message);

/// The picture of a sensor_msgs/Image: mono8, mono16, rgb, bgr, rgba, bgra with 8 or 16 bits, bayer_* with 8 or 16
/// (comes out as BGR), 8UC1, 8UC3, 16UC1. Throws Error that begins with `source`.
Frame read_image(const std::string& source, const std::vector<std::uint8_t>& message);

/// The picture of a sensor_msgs/CompressedImage: JPEG or PNG. Throws Error that begins with `source`.
Frame read_compressed_image(const std::string& source, const std::vector<std::uint8_t>& message);

/// A sensor_msgs/CameraInfo. Throws Error that begins with `source`, also when it is that of a part of the sensor.
CameraInfo read_camera_info(const std::string& source, const std::vector<std::uint8_t>& message);

}  // namespace roadstereo::io
