#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/camera_info.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

// Parser of serialised ROS 1 messages: little-endian, lists and texts preceded by their length. Own parser because the
// message headers of ROS do not compile as C++20.

/// Returns the time stamp of the message header, nanoseconds; 0: none. Throws Error.
std::int64_t stamp_ns(const std::string& source, const std::vector<std::uint8_t>& message);

/// Decodes a sensor_msgs/Image: mono, rgb, bgr, rgba, bgra with 8 or 16 bits, bayer_* with 8 or 16 bits (converted to
/// BGR), 8UC1, 8UC3, 16UC1. Throws Error; the message starts with `source`.
Frame read_image(const std::string& source, const std::vector<std::uint8_t>& message);

/// Decodes a sensor_msgs/CompressedImage: JPEG or PNG. Throws Error; the message starts with `source`.
Frame read_compressed_image(const std::string& source, const std::vector<std::uint8_t>& message);

/// Parses a sensor_msgs/CameraInfo. Throws Error, also for binning or a region of interest; it starts with `source`.
CameraInfo read_camera_info(const std::string& source, const std::vector<std::uint8_t>& message);

}  // namespace roadstereo::io
