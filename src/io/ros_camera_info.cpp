#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

struct CameraInfo {
  int width = 0;
  int height = 0;
  bool fisheye = false;
  cv::Matx33d k;
  std::vector<double> d;
  cv::Matx33d r;  // camera to rectified camera
  cv::Matx34d p;  // of the rectified camera
};

template <int Columns>
cv::Matx<double, 3, Columns> read_matrix(const CalibrationText& file, const YAML::Node& root, const std::string& key) {
  const YAML::Node node = root[key];
  const YAML::Node data = node && node.IsMap() ? node["data"] : node;
  const std::vector<double> figures = yaml_figures(file, data, key);
  constexpr auto count = static_cast<std::size_t>(3 * Columns);
  if (figures.size() != count) fail(file.path, ": ", key, " has ", figures.size(), " figures; it must have ", count);
  return cv::Matx<double, 3, Columns>(figures.data());
}

bool is_fisheye(const CalibrationText& file, const YAML::Node& root) {
  const YAML::Node node = root["distortion_model"];
  const std::string model = node && node.IsScalar() ? node.Scalar() : "plumb_bob";
  if (model == "equidistant" || model == "fisheye") return true;
  if (model == "plumb_bob" || model == "rational_polynomial" || model.empty()) return false;
  fail(file.path, ": distortion_model is \"", model,
       "\"; it must be plumb_bob, rational_polynomial, equidistant or fisheye");
}

CameraInfo read_camera(const CalibrationText& file) {
  const YAML::Node root = load_yaml(file);
  CameraInfo camera;
  camera.width = yaml_side(file, root, "image_width");
  camera.height = yaml_side(file, root, "image_height");
  camera.fisheye = is_fisheye(file, root);
  camera.k = read_matrix<3>(file, root, "camera_matrix");
  camera.r = read_matrix<3>(file, root, "rectification_matrix");
  camera.p = read_matrix<4>(file, root, "projection_matrix");
  const YAML::Node distortion = root["distortion_coefficients"];
  const YAML::Node data = distortion && distortion.IsMap() ? distortion["data"] : distortion;
  camera.d = yaml_figures(file, data, "distortion_coefficients");
  if (!(camera.p(0, 0) > 0)) {
    fail(file.path, ": projection_matrix[0] is ", camera.p(0, 0), "; it must be the rectified focal length in pixels");
  }
  return camera;
}

std::array<double, 9> figures_of(const cv::Matx33d& m) {
  std::array<double, 9> figures{};
  std::copy(m.val, m.val + 9, figures.begin());
  return figures;
}

void check_pair(const CalibrationText& left_file, const CameraInfo& left, const CalibrationText& right_file,
                const CameraInfo& right) {
  if (left.width != right.width || left.height != right.height) {
    fail(right_file.path, ": the camera has ", right.width, "×", right.height, " pixels, but ", left_file.path, " has ",
         left.width, "×", left.height);
  }
  if (left.fisheye != right.fisheye) fail(right_file.path, ": distortion_model differs from ", left_file.path);
  if (std::abs(left.p(0, 0) - right.p(0, 0)) > 1e-6 * left.p(0, 0)) {
    fail(right_file.path, ": projection_matrix has the focal length ", right.p(0, 0), ", but ", left_file.path, " has ",
         left.p(0, 0));
  }
}

/// The camera's images are those of the rectified camera.
bool is_rectified(const CameraInfo& camera) {
  const bool undistorted = std::all_of(camera.d.begin(), camera.d.end(), [](double d) { return d == 0; });
  const cv::Matx33d p = camera.p.get_minor<3, 3>(0, 0);
  return undistorted && !camera.fisheye && cv::norm(camera.r - cv::Matx33d::eye()) < 1e-9 &&
         cv::norm(camera.k - p) < 1e-6 * p(0, 0);
}

/// Position of the right camera's centre in the rectified left camera is −shift, metres.
cv::Vec3d rectified_shift(const CameraInfo& left, const CameraInfo& right) {
  const double f = left.p(0, 0);
  return {(right.p(0, 3) - left.p(0, 3)) / f, (right.p(1, 3) - left.p(1, 3)) / f, 0};
}

CalibrationFile rectified_file(const CalibrationText& right_file, const CameraInfo& left, const CameraInfo& right) {
  StereoCalibration calibration;
  calibration.focal_px = left.p(0, 0);
  calibration.cx_px = left.p(0, 2);
  calibration.cy_px = left.p(1, 2);
  calibration.baseline_m = -rectified_shift(left, right)[0];
  calibration.disparity_offset_px = right.p(0, 2) - left.p(0, 2);
  calibration.width = left.width;
  calibration.height = left.height;
  check_square_pixels(left.p(0, 0), left.p(1, 1), right_file.path, "projection_matrix");
  check_rectified(calibration, right_file.path,
                  {"projection_matrix[0]", "projection_matrix[2]", "projection_matrix[6]", "projection_matrix[3]"});
  return {"ROS camera_info", calibration, std::nullopt};
}

/// Rectified coordinates are R_left·x_left and R_right·x_right, and differ by the shift alone:
/// x_right = R_rightᵀ·R_left·x_left + R_rightᵀ·shift.
StereoRig rig_of(const CameraInfo& left, const CameraInfo& right) {
  const cv::Vec3d translation = right.r.t() * rectified_shift(left, right);
  StereoRig rig;
  rig.left_matrix = figures_of(left.k);
  rig.right_matrix = figures_of(right.k);
  rig.left_distortion = left.d;
  rig.right_distortion = right.d;
  rig.rotation = figures_of(right.r.t() * left.r);
  rig.translation_m = {translation[0], translation[1], translation[2]};
  rig.fisheye = left.fisheye;
  rig.width = left.width;
  rig.height = left.height;
  return rig;
}

}  // namespace

CalibrationFile read_ros_camera_info(const CalibrationText& left_file, const CalibrationText& right_file) {
  const CameraInfo left = read_camera(left_file);
  const CameraInfo right = read_camera(right_file);
  check_pair(left_file, left, right_file, right);
  if (is_rectified(left) && is_rectified(right)) return rectified_file(right_file, left, right);
  const StereoRig rig = rig_of(left, right);
  check_rig(rig, left_file.path + " and " + right_file.path);
  return {"ROS camera_info", std::nullopt, rig};
}

}  // namespace roadstereo::io
