#include "io/rig_camera.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::array<double, 9> camera_matrix(double fx, double fy, double cx, double cy) {
  return {fx, 0, cx, 0, fy, cy, 0, 0, 1};
}

StereoRig join_cameras(const RigCamera& left, const RigCamera& right, const cv::Matx44d& left_to_right,
                       const std::string& source) {
  if (left.width != right.width || left.height != right.height) {
    fail(source, ": the left camera has ", left.width, "×", left.height, " pixels and the right one ", right.width, "×",
         right.height, "; they must have the same");
  }
  if (left.fisheye != right.fisheye) fail(source, ": the lens models of the cameras differ");
  StereoRig rig;
  rig.left_matrix = left.matrix;
  rig.right_matrix = right.matrix;
  rig.left_distortion = left.distortion;
  rig.right_distortion = right.distortion;
  const cv::Matx44d& m = left_to_right;
  rig.rotation = {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
  rig.translation_m = {m(0, 3), m(1, 3), m(2, 3)};
  rig.fisheye = left.fisheye;
  rig.width = left.width;
  rig.height = left.height;
  return rig;
}

}  // namespace roadstereo::io
