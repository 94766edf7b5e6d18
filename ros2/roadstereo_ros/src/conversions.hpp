// Between messages of ROS 2 and roadstereo's types.
#pragma once

#include <roadstereo/pipeline.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_msgs/msg/header.hpp>
#include <stereo_msgs/msg/disparity_image.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

namespace roadstereo_ros {

/// Views an image without a copy: mono, bgr, rgb, bgra, rgba with 8 or 16 bits. Throws roadstereo::Error for others,
/// and when its data are too short.
roadstereo::FrameView frame_view(const sensor_msgs::msg::Image& image);

/// Calibration of rectified images by the projection matrices, metres. Throws roadstereo::Error when they are not
/// those of a rectified pair of one focal length.
roadstereo::StereoCalibration stereo_calibration(const sensor_msgs::msg::CameraInfo& left,
                                                 const sensor_msgs::msg::CameraInfo& right);

/// Disparities of cameras with equal principal points, NaN invalid.
stereo_msgs::msg::DisparityImage disparity_image(const std_msgs::msg::Header& header,
                                                 const roadstereo::FrameResult& result,
                                                 const roadstereo::StereoCalibration& calibration);

/// Points in the frame of the left camera: x, y, z, sigma (standard error of z, metres), intensity (0 … 255).
sensor_msgs::msg::PointCloud2 point_cloud(const std_msgs::msg::Header& header, const roadstereo::FrameResult& result,
                                          const roadstereo::StereoCalibration& calibration);

/// Outline of every damage with metrics in the frame of the left camera, after a marker that deletes the last ones.
visualization_msgs::msg::MarkerArray damage_markers(const std_msgs::msg::Header& header,
                                                    const roadstereo::FrameResult& result,
                                                    const roadstereo::DamageMap& damage,
                                                    const roadstereo::StereoCalibration& calibration);

}  // namespace roadstereo_ros
