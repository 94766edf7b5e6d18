#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/camera_info.hpp"
#include "io/source/bag_topics.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

// Parser of serialised ROS messages, little-endian. ROS 1: lists and texts preceded by their length; own parser because
// the message headers of ROS do not compile as C++20. ROS 2: CDR of the OMG, values aligned to their size.

/// Returns the time stamp of the message header, nanoseconds; 0: none. Throws Error.
std::int64_t stamp_ns(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format);

/// Decodes a sensor_msgs/Image: mono, rgb, bgr, rgba, bgra with 8 or 16 bits, bayer_* with 8 or 16 bits and yuv422
/// (uyvy, yuyv; both converted to BGR), 8UC1, 8UC3, 16UC1. Throws Error; the message starts with `source`.
Frame read_image(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format);

/// Decodes a sensor_msgs/CompressedImage: JPEG, PNG, TIFF or PNM. Throws Error; the message starts with `source`.
Frame read_compressed_image(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format);

/// Parses a sensor_msgs/CameraInfo. Throws Error, also for binning or a region of interest; it starts with `source`.
CameraInfo read_camera_info(const std::string& source, const std::vector<std::uint8_t>& message, MessageFormat format);

/// A sensor_msgs/NavSatFix.
struct SatelliteFix {
  std::int64_t stamp_ns = 0;  ///< 0: none
  bool valid = false;         ///< false: the receiver had no fix
  double lat_deg = 0, lon_deg = 0;
  double alt_m = 0;                                             ///< above the ellipsoid; NaN: unknown
  double horizontal_variance_m2 = 0, vertical_variance_m2 = 0;  ///< per axis; 0: unknown
};

/// Parses a sensor_msgs/NavSatFix. Throws Error.
SatelliteFix read_satellite_fix(const std::string& source, const std::vector<std::uint8_t>& message,
                                MessageFormat format);

}  // namespace roadstereo::io
