#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"

namespace roadstereo::io {

/// A rig as a calibration program leaves it: lenses distort, cameras are not parallel. Matrices row-major.
struct StereoRig {
  std::array<double, 9> left_matrix{};    ///< K1, pixels
  std::vector<double> left_distortion;    ///< D1, OpenCV order; empty = none
  std::array<double, 9> right_matrix{};   ///< K2
  std::vector<double> right_distortion;   ///< D2
  std::array<double, 9> rotation{};       ///< R: left camera to right camera
  std::array<double, 3> translation_m{};  ///< T: left camera to right camera, metres
  bool fisheye = false;                   ///< equidistant model instead of OpenCV's plumb-bob / rational
  int width = 0;                          ///< 0 when the file does not say
  int height = 0;
};

/// What a calibration file says.
struct CalibrationFile {
  std::string format;                          ///< e.g. "plain YAML", "OpenCV stereo", "ROS camera_info", "KITTI P2/P3"
  std::optional<StereoCalibration> rectified;  ///< the images are rectified already
  std::optional<StereoRig> rig;                ///< the images must be rectified first
};

/// Reads a calibration; the format is recognised by content, not by name:
///   plain YAML     focal_px, cx_px, cy_px, baseline_m, width, height
///   OpenCV stereo  YAML or XML with K1 D1 K2 D2 R T, or M1 D1 M2 D2 R T (T in metres)
///   ROS            camera_info; `second_path` is the right camera's file
///   KITTI          calib*.txt with P0/P1 or P2/P3 (also P_rect_0N); P2/P3 wins when a file has both
///   Middlebury     calib.txt with cam0, cam1, doffs, baseline in millimetres
///   K.txt          nine figures of K and the baseline in metres
/// Throws Error naming the file and the figure that is missing, not finite or absurd.
CalibrationFile read_calibration(const std::string& path, const std::string& second_path = "");

}  // namespace roadstereo::io
