#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Calibration of an unrectified stereo rig. Matrices are row-major.
struct StereoRig {
  std::array<double, 9> left_matrix{};    ///< K1, pixels
  std::vector<double> left_distortion;    ///< D1, OpenCV order; empty: no distortion
  std::array<double, 9> right_matrix{};   ///< K2
  std::vector<double> right_distortion;   ///< D2
  std::array<double, 9> rotation{};       ///< R: left camera to right camera
  std::array<double, 3> translation_m{};  ///< T: left camera to right camera, metres
  bool fisheye = false;                   ///< equidistant model instead of OpenCV's plumb-bob / rational
  int width = 0;                          ///< pixels; 0: not in the file
  int height = 0;
};

/// Contents of a calibration file: exactly one of `rectified`, `rig` and `rigs` is set.
struct CalibrationFile {
  std::string format;                          ///< e.g. "plain YAML", "OpenCV stereo", "ROS camera_info", "KITTI P2/P3"
  std::optional<StereoCalibration> rectified;  ///< the images are already rectified
  std::optional<StereoRig> rig;                ///< the images must be rectified first
  std::vector<StereoRig> rigs{};               ///< one rig per image size, from which `select_size` takes one: it
                                               ///< becomes `rig` or `rectified`

  /// Makes the member of `rigs` of that size the `rig`, or `rectified` if it needs no rectification; does nothing
  /// without `rigs`. Throws Error naming the sizes.
  void select_size(int width, int height, const std::string& source);

  /// Says that the file has no image size and that its principal point lies far from the middle of images of that size,
  /// as it does where they were scaled after the calibration; empty if not.
  std::string size_doubt(int width, int height) const;
};

/// Reads a calibration; the format is recognised by content, not by name:
///   plain YAML     focal_px, cx_px, cy_px, baseline_m, width, height
///   OpenCV stereo  YAML or XML with K1 D1 K2 D2 R T, or M1 D1 M2 D2 R T (T in metres)
///   ROS            camera_info, as calibration tools write it or `topic echo` prints it (ROS 1 and 2);
///                  `second_path` is the right camera's file
///   Kalibr         camchain.yaml with cam0 (left) and cam1: pinhole with radtan, equidistant or none
///   EuRoC          sensor.yaml with T_BS; `second_path` is the right camera's file
///   ZED            SN*.conf, one rig per resolution
///   DepthAI        JSON of the calibration that is stored in the device
///   RealSense      JSON of the calibration that the RealSense Viewer saves, one per size of the rectified images
///   COLMAP         cameras.txt; `second_path` is rigs.txt with one rig of two cameras, or images.txt with images of
///                  the same name in two folders (the mean of their poses); metres
///   KITTI          calib*.txt with P0/P1 or P2/P3 (also P_rect_0N); P2/P3 wins when a file has both
///   Middlebury     calib.txt with cam0, cam1, doffs, baseline in millimetres
///   K.txt          nine values of K and the baseline in metres
/// Throws Error naming the file and the value that is missing, not finite or out of range.
CalibrationFile read_calibration(const std::string& path, const std::string& second_path = "");

}  // namespace roadstereo::io
#pragma GCC visibility pop
