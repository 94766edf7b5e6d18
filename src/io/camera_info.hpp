#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// ROS camera_info: one camera of a pair and its rectification.
struct CameraInfo {
  std::string source;  ///< file or topic, starts error messages
  int width = 0;       ///< pixels; 0: unknown
  int height = 0;
  std::string distortion_model;  ///< plumb_bob, rational_polynomial, equidistant or fisheye; empty: plumb_bob
  cv::Matx33d k;                 ///< camera matrix
  std::vector<double> d;         ///< distortion
  cv::Matx33d r;                 ///< camera to rectified camera
  cv::Matx34d p;                 ///< projection matrix of the rectified camera
};

/// Joins two cameras to a rig: `rectified` if the images of both are already rectified. Throws Error naming the camera
/// and the value that is missing, out of range or inconsistent.
CalibrationFile join_camera_infos(const CameraInfo& left, const CameraInfo& right);

}  // namespace roadstereo::io
