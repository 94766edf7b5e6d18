#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// One camera of an unrectified rig.
struct RigCamera {
  std::array<double, 9> matrix{};  ///< pixels, row-major
  std::vector<double> distortion;  ///< OpenCV order
  bool fisheye = false;            ///< equidistant model
  int width = 0;                   ///< pixels
  int height = 0;
};

/// Returns the camera matrix without skew.
std::array<double, 9> camera_matrix(double fx, double fy, double cx, double cy);

/// Joins two cameras. `left_to_right` takes points of the left camera to the right one, metres. Throws Error starting
/// with `source` if sizes or lens models differ.
StereoRig join_cameras(const RigCamera& left, const RigCamera& right, const cv::Matx44d& left_to_right,
                       const std::string& source);

}  // namespace roadstereo::io
