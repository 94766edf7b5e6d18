#include "io/camera_info.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

bool is_fisheye(const CameraInfo& camera) {
  const std::string& model = camera.distortion_model;
  if (model == "equidistant" || model == "fisheye") return true;
  if (model == "plumb_bob" || model == "rational_polynomial" || model.empty()) return false;
  fail(camera.source, ": distortion_model is \"", model,
       "\"; it must be plumb_bob, rational_polynomial, equidistant or fisheye");
}

void check_projection(const CameraInfo& camera) {
  if (camera.p(0, 0) > 0) return;
  fail(camera.source, ": projection_matrix[0] is ", camera.p(0, 0),
       "; it must be the rectified focal length in pixels");
}

std::array<double, 9> values_of(const cv::Matx33d& m) {
  std::array<double, 9> values{};
  std::copy(m.val, m.val + 9, values.begin());
  return values;
}

void check_pair(const CameraInfo& left, const CameraInfo& right) {
  if (left.width != right.width || left.height != right.height) {
    fail(right.source, ": the camera has ", right.width, "×", right.height, " pixels, but ", left.source, " has ",
         left.width, "×", left.height);
  }
  if (is_fisheye(left) != is_fisheye(right)) fail(right.source, ": distortion_model differs from ", left.source);
  check_one_projection("projection_matrix", {left.source, left.p(0, 0), left.p(1, 2)},
                       {right.source, right.p(0, 0), right.p(1, 2)});
}

/// Whether the images of the camera are already rectified.
bool is_rectified(const CameraInfo& camera) {
  const bool undistorted = std::all_of(camera.d.begin(), camera.d.end(), [](double d) { return d == 0; });
  const cv::Matx33d p = camera.p.get_minor<3, 3>(0, 0);
  return undistorted && !is_fisheye(camera) && cv::norm(camera.r - cv::Matx33d::eye()) < 1e-9 &&
         cv::norm(camera.k - p) < 1e-6 * p(0, 0);
}

/// The centre of the right camera is at −shift in the rectified left camera, metres.
cv::Vec3d rectified_shift(const CameraInfo& left, const CameraInfo& right) {
  const double f = left.p(0, 0);
  return {(right.p(0, 3) - left.p(0, 3)) / f, (right.p(1, 3) - left.p(1, 3)) / f, 0};
}

CalibrationFile rectified_file(const CameraInfo& left, const CameraInfo& right) {
  StereoCalibration calibration;
  calibration.focal_px = left.p(0, 0);
  calibration.cx_px = left.p(0, 2);
  calibration.cy_px = left.p(1, 2);
  calibration.baseline_m = -rectified_shift(left, right)[0];
  calibration.disparity_offset_px = right.p(0, 2) - left.p(0, 2);
  calibration.width = left.width;
  calibration.height = left.height;
  check_square_pixels(left.p(0, 0), left.p(1, 1), right.source, "projection_matrix");
  check_rectified(calibration, right.source,
                  {"projection_matrix[0]", "projection_matrix[2]", "projection_matrix[6]", "projection_matrix[3]"});
  return {"ROS camera_info", calibration, std::nullopt};
}

/// Rectified coordinates R_left·x_left and R_right·x_right differ only by the shift:
/// x_right = R_rightᵀ·R_left·x_left + R_rightᵀ·shift.
StereoRig rig_of(const CameraInfo& left, const CameraInfo& right) {
  const cv::Vec3d translation = right.r.t() * rectified_shift(left, right);
  StereoRig rig;
  rig.left_matrix = values_of(left.k);
  rig.right_matrix = values_of(right.k);
  rig.left_distortion = left.d;
  rig.right_distortion = right.d;
  rig.rotation = values_of(right.r.t() * left.r);
  rig.translation_m = {translation[0], translation[1], translation[2]};
  rig.fisheye = is_fisheye(left);
  rig.width = left.width;
  rig.height = left.height;
  return rig;
}

}  // namespace

CalibrationFile join_camera_infos(const CameraInfo& left, const CameraInfo& right) {
  check_projection(left);
  check_projection(right);
  check_pair(left, right);
  if (is_rectified(left) && is_rectified(right)) return rectified_file(left, right);
  const StereoRig rig = rig_of(left, right);
  check_rig(rig, left.source + " and " + right.source);
  return {"ROS camera_info", std::nullopt, rig};
}

}  // namespace roadstereo::io
