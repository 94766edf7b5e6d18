#pragma once

#include <string_view>

/// Texts of message types, and of all types in them, as ROS 2 Humble to Jazzy have them; embedded from this folder at
/// build time.
namespace roadstereo::io::ros_definitions {

extern const std::string_view camera_info;      ///< CameraInfo.msg
extern const std::string_view disparity_image;  ///< DisparityImage.msg
extern const std::string_view image;            ///< CompressedImage.msg
extern const std::string_view marker_array;     ///< MarkerArray.msg
extern const std::string_view odometry;         ///< Odometry.msg
extern const std::string_view point_cloud;      ///< PointCloud2.msg
extern const std::string_view transforms;       ///< TFMessage.msg

}  // namespace roadstereo::io::ros_definitions
