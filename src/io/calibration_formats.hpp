#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// A calibration file as text.
struct CalibrationText {
  std::string path;
  std::string text;
};

// One reader per format. Each throws Error naming the file and the value.
CalibrationFile read_plain_yaml(const CalibrationText& file);
/// `second`, if given, is another file of the same format with the keys missing in the first.
CalibrationFile read_opencv_stereo(const CalibrationText& file, const CalibrationText* second);
CalibrationFile read_ros_camera_info(const CalibrationText& left, const CalibrationText& right);
CalibrationFile read_kalibr_camchain(const CalibrationText& file);
CalibrationFile read_euroc_sensors(const CalibrationText& left, const CalibrationText& right);
CalibrationFile read_zed_conf(const CalibrationText& file);
CalibrationFile read_depthai(const CalibrationText& file);
/// The calibration that the RealSense Viewer saves: one rig per size of the images.
CalibrationFile read_realsense(const CalibrationText& file);
/// cameras.txt, and rigs.txt or images.txt.
CalibrationFile read_colmap(const CalibrationText& cameras, const CalibrationText& poses);
CalibrationFile read_kitti(const CalibrationText& file);
CalibrationFile read_middlebury(const CalibrationText& file);
CalibrationFile read_k_txt(const CalibrationText& file);

/// Parses a finite number. Throws Error naming `path` and `key`.
double parse_number(const std::string& path, const std::string& key, std::string_view text);
/// The side of an image, if that is a whole number of 1 … 65535 pixels. Throws Error naming `path` and `key` if not.
int image_side(const std::string& path, const std::string& key, double side);
/// Parses the side of an image.
int parse_side(const std::string& path, const std::string& key, std::string_view text);
/// Splits text at white space and at any of `separators`.
std::vector<std::string_view> split_words(std::string_view text, std::string_view separators = "");

/// One line "key: value" or "key = value" of a text file.
struct KeyLine {
  std::string_view key;
  std::string_view value;
};
/// Returns the lines of `text` that contain `separator`.
std::vector<KeyLine> key_lines(std::string_view text, char separator);
/// Returns the line with that key, or null.
const KeyLine* find_key(const std::vector<KeyLine>& lines, std::string_view key);

/// Whether it is COLMAP's cameras.txt.
bool is_colmap_cameras(std::string_view text);

/// Names of the values of a rectified rig in its file, for error messages.
struct FigureNames {
  std::string focal;
  std::string cx;
  std::string cy;
  std::string baseline;
};

/// Checks a rectified calibration. Throws Error if a value is not finite, or the focal length or baseline is out of
/// range.
void check_rectified(const StereoCalibration& calibration, const std::string& source, const FigureNames& names);

/// What both cameras of a rectified pair have in common, and the name of the camera or its matrix.
struct CameraFigures {
  std::string name;
  double focal_px = 0;
  double cy_px = 0;
};
/// Throws Error if the focal lengths differ, or the rows of the principal points by more than half a pixel.
void check_one_projection(const std::string& source, const CameraFigures& left, const CameraFigures& right);

/// Throws Error if the focal lengths of columns and rows differ.
void check_square_pixels(double fx, double fy, const std::string& source, const std::string& matrix);

/// Checks an unrectified rig. Throws Error if a value is not finite, a focal length or the baseline is out of range, R
/// is not a rotation, or the number of distortion coefficients fits no lens model.
void check_rig(const StereoRig& rig, const std::string& source);

/// What `CalibrationFile::size_doubt` says of a principal point of a file without an image size.
std::string principal_point_doubt(double cx_px, double cy_px, int width, int height);

/// Checks the rig; returns it as `rectified` if it needs no rectification.
CalibrationFile describe_rig(const StereoRig& rig, const std::string& format, const std::string& source);

}  // namespace roadstereo::io
