#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// What ROS calls camera_info: one camera of a pair, and the camera that it becomes when rectified.
struct CameraInfo {
  std::string source;  ///< file or topic, opens messages
  int width = 0;       ///< pixels; 0 when it is not said
  int height = 0;
  std::string distortion_model;  ///< plumb_bob, rational_polynomial, equidistant or fisheye; empty is plumb_bob
  cv::Matx33d k;                 ///< camera matrix
  std::vector<double> d;         ///< distortion
  cv::Matx33d r;                 ///< camera to rectified camera
  cv::Matx34d p;                 ///< of the rectified camera
};

/// The rig of the two cameras: rectified when both are as they become, else one to be rectified. Throws Error naming
/// the camera and the figure that is missing, absurd or not the other camera's.
CalibrationFile join_camera_infos(const CameraInfo& left, const CameraInfo& right);

}  // namespace roadstereo::io
