// Messages of ROS 2 (Humble to Jazzy), serialised as CDR.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/ros/header.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

using RosMessage = std::vector<std::uint8_t>;

/// geometry_msgs/TransformStamped
struct RosTransform {
  RosHeader header;                          ///< its frame is the parent
  std::string child;                         ///< frame
  std::array<double, 12> child_to_parent{};  ///< 3×4, row-major, metres
};

/// Maps of a frame, W×H.
struct RosPoints {
  ImageView<const float> disparity;    ///< pixels, NaN invalid
  ImageView<const float> sigma;        ///< standard error of the disparity, pixels
  ImageView<const std::int16_t> grey;  ///< sixteenths of grey levels
};

/// sensor_msgs/CompressedImage
RosMessage compressed_image(const RosHeader& header, std::span<const std::uint8_t> jpeg);

/// sensor_msgs/CameraInfo of the left camera of a rectified pair.
RosMessage camera_info(const RosHeader& header, const StereoCalibration& calibration, int width, int height);

/// stereo_msgs/DisparityImage. Disparities are those of cameras with equal principal points (`disparity_offset_px`
/// added), NaN invalid; f and T are 0 without a calibration.
RosMessage disparity_image(const RosHeader& header, ImageView<const float> disparity,
                           const StereoCalibration* calibration);

/// sensor_msgs/PointCloud2 of the pixels with a disparity, of at least `min_cloud_disparity_px`, row by row, camera
/// frame: float32 x, y, z, sigma (standard error of z, metres), intensity (0 … 255).
RosMessage point_cloud(const RosHeader& header, const RosPoints& maps, const StereoCalibration& calibration);

/// visualization_msgs/MarkerArray in the axes of `road_axes`: first one that deletes those of the last frame, then
/// outline and text of every damage with metrics. Seen from the height of the camera, letters are as high as 1/20.
RosMessage damage_markers(const RosHeader& header, std::span<const Damage> damages, double camera_height_m);

/// nav_msgs/Odometry without a twist. `covariance`: 6×6, position and rotation about the axes of the header's frame.
RosMessage odometry_message(const RosTransform& pose, const std::array<double, 36>& covariance);

/// tf2_msgs/TFMessage
RosMessage transforms(std::span<const RosTransform> transforms);

}  // namespace roadstereo::io
