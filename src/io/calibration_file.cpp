#include "roadstereo/io/calibration_file.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <string_view>

#include "io/calibration_formats.hpp"
#include "io/file_bytes.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 20U;
constexpr std::size_t max_images_bytes = std::size_t{1} << 28U;  // COLMAP's, with the points of every image

enum class Format {
  plain_yaml,
  opencv_stereo,
  ros_camera_info,
  kalibr,
  euroc,
  zed,
  depthai,
  realsense,
  colmap,
  kitti,
  middlebury,
  k_txt,
  unknown
};

CalibrationText read_calibration_text(const std::string& path, std::size_t limit = max_bytes) {
  return {path, read_text(path, limit, "not a text file; a calibration must be one")};
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool has_any_key(const std::vector<KeyLine>& lines, std::initializer_list<std::string_view> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) { return find_key(lines, key) != nullptr; });
}

bool is_opencv(std::string_view text) {
  return text.starts_with("%YAML:") || contains(text, "<opencv_storage") || contains(text, "opencv-matrix");
}

/// Whether the file starts with a number; the reader checks the others.
bool is_k_txt(std::string_view text) {
  const std::vector<std::string_view> words = split_words(text, ",");
  constexpr std::string_view beginnings = "+-.0123456789";
  return words.size() >= 2 && contains(beginnings, words.front().substr(0, 1));
}

/// Whether it is a file of a calibration tool, or a message as `topic echo` prints it.
bool is_camera_info(const std::vector<KeyLine>& colon) {
  return has_any_key(colon, {"camera_matrix", "projection_matrix", "rectification_matrix"}) ||
         (has_any_key(colon, {"distortion_model"}) && has_any_key(colon, {"p", "P"}));
}

Format recognise(const std::string& text) {
  const std::vector<KeyLine> colon = key_lines(text, ':');
  const std::vector<KeyLine> equals = key_lines(text, '=');
  if (contains(text, "\"cameraData\"") && contains(text, "\"stereoRectificationData\"")) return Format::depthai;
  if (contains(text, "\"rectified.0.fx\"")) return Format::realsense;
  if (has_any_key(colon, {"T_BS"})) return Format::euroc;
  if (is_opencv(text)) return Format::opencv_stereo;
  if (has_any_key(colon, {"T_cn_cnm1", "distortion_coeffs"})) return Format::kalibr;
  if (contains(text, "[LEFT_CAM_")) return Format::zed;
  if (is_camera_info(colon)) return Format::ros_camera_info;
  if (has_any_key(colon, {"focal_px", "cx_px", "cy_px", "baseline_m"})) return Format::plain_yaml;
  if (has_any_key(colon, {"P0", "P1", "P2", "P3", "P_rect_00", "P_rect_01", "P_rect_02", "P_rect_03"})) {
    return Format::kitti;
  }
  if (has_any_key(equals, {"cam0", "cam1"})) return Format::middlebury;
  if (is_colmap_cameras(text)) return Format::colmap;
  return is_k_txt(text) ? Format::k_txt : Format::unknown;
}

[[noreturn]] void fail_second(const CalibrationText& file, const std::string& second_path) {
  fail(file.path, ": this calibration describes both cameras; remove the second file, ", second_path);
}

CalibrationFile read_as(Format format, const CalibrationText& file, const std::string& second_path) {
  const bool has_second = !second_path.empty();
  if (format == Format::ros_camera_info || format == Format::euroc) {
    const bool is_ros = format == Format::ros_camera_info;
    if (!has_second) {
      fail(file.path, ": this is the ", is_ros ? "camera_info" : "sensor.yaml",
           " of one camera; the file of the right camera is needed, too");
    }
    const CalibrationText second = read_calibration_text(second_path);
    return is_ros ? read_ros_camera_info(file, second) : read_euroc_sensors(file, second);
  }
  if (format == Format::colmap) {
    if (!has_second) {
      fail(file.path, ": this is COLMAP's cameras.txt; rigs.txt or images.txt with the poses is needed, too");
    }
    return read_colmap(file, read_calibration_text(second_path, max_images_bytes));
  }
  if (format == Format::opencv_stereo) {
    if (!has_second) return read_opencv_stereo(file, nullptr);
    const CalibrationText second = read_calibration_text(second_path);
    return read_opencv_stereo(file, &second);
  }
  if (format == Format::unknown) {
    fail(file.path,
         ": unknown calibration format; supported are plain YAML (focal_px, cx_px, cy_px, baseline_m), "
         "OpenCV stereo, ROS camera_info, Kalibr, EuRoC, ZED, RealSense, DepthAI, COLMAP, KITTI, Middlebury and K.txt");
  }
  if (has_second) fail_second(file, second_path);
  switch (format) {
    case Format::plain_yaml:
      return read_plain_yaml(file);
    case Format::kalibr:
      return read_kalibr_camchain(file);
    case Format::zed:
      return read_zed_conf(file);
    case Format::depthai:
      return read_depthai(file);
    case Format::realsense:
      return read_realsense(file);
    case Format::kitti:
      return read_kitti(file);
    case Format::middlebury:
      return read_middlebury(file);
    default:
      return read_k_txt(file);
  }
}

}  // namespace

void CalibrationFile::select_size(int width, int height, const std::string& source) {
  if (rigs.empty()) return;
  std::string sizes;
  for (const StereoRig& of_size : rigs) {
    if (of_size.width == width && of_size.height == height) {
      const StereoRig chosen = of_size;
      *this = describe_rig(chosen, format, source);
      return;
    }
    sizes += (sizes.empty() ? "" : ", ") + std::to_string(of_size.width) + "×" + std::to_string(of_size.height);
  }
  fail(source, ": the images have ", width, "×", height, " pixels; the calibrations are for ", sizes);
}

CalibrationFile read_calibration(const std::string& path, const std::string& second_path) {
  const CalibrationText file = read_calibration_text(path);
  try {
    return read_as(recognise(file.text), file, second_path);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // of a parser
    fail(path, ": invalid calibration: ", error.what());
  }
}

}  // namespace roadstereo::io
