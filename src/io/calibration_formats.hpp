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

// One reader per format; each throws Error naming the file and the figure.
CalibrationFile read_plain_yaml(const CalibrationText& file);
/// `second`, when given, is another file of the same kind that holds the keys missing in the first.
CalibrationFile read_opencv_stereo(const CalibrationText& file, const CalibrationText* second);
CalibrationFile read_ros_camera_info(const CalibrationText& left, const CalibrationText& right);
CalibrationFile read_kitti(const CalibrationText& file);
CalibrationFile read_middlebury(const CalibrationText& file);
CalibrationFile read_k_txt(const CalibrationText& file);

/// A number; throws Error when `text` is none or is not finite.
double parse_figure(const std::string& path, const std::string& key, std::string_view text);
/// Side of an image in pixels; throws Error when `text` is no whole number from 1 to 65535.
int parse_side(const std::string& path, const std::string& key, std::string_view text);
/// Words of a line or a file, separated by white space or one of `separators`.
std::vector<std::string_view> split_words(std::string_view text, std::string_view separators = "");

/// One line "key: value" or "key = value" of a text file.
struct KeyLine {
  std::string_view key;
  std::string_view value;
};
/// The lines of `text` that have the `separator` in them.
std::vector<KeyLine> key_lines(std::string_view text, char separator);
/// The line with that key; null when there is none.
const KeyLine* find_key(const std::vector<KeyLine>& lines, std::string_view key);

/// What the figures of a rectified rig are called in the file, for the sentence that refuses one.
struct FigureNames {
  std::string focal;
  std::string cx;
  std::string cy;
  std::string baseline;
};

/// Refuses what is wrong whatever the image: figures that are not finite, an impossible focal length or
/// baseline.
void check_rectified(const StereoCalibration& calibration, const std::string& source, const FigureNames& names);

/// One focal length must do for columns and rows.
void check_square_pixels(double fx, double fy, const std::string& source, const std::string& matrix);

/// Refuses figures that are not finite, impossible focal lengths, a rotation that is none, an absurd distance
/// between the cameras, a number of distortion coefficients that no model has.
void check_rig(const StereoRig& rig, const std::string& source);

/// A checked rig, as a rectified one when it needs no rectification.
CalibrationFile describe_rig(const StereoRig& rig, const std::string& format, const std::string& source);

}  // namespace roadstereo::io
