#include "io/ros/road_odometry.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "roadstereo/ground_plane.hpp"

namespace roadstereo::io {
namespace {

cv::Matx33d rotation_of(const std::array<double, 12>& m) {
  return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
}

cv::Vec3d translation_of(const std::array<double, 12>& m) {
  return {m[3], m[7], m[11]};
}

std::array<double, 12> joined(const cv::Matx33d& r, const cv::Vec3d& t) {
  return {r(0, 0), r(0, 1), r(0, 2), t[0], r(1, 0), r(1, 1), r(1, 2), t[1], r(2, 0), r(2, 1), r(2, 2), t[2]};
}

/// A covariance of position and rotation, both turned by `r`.
std::array<double, 36> turned(const std::array<double, 36>& covariance, const cv::Matx33d& r) {
  cv::Matx<double, 6, 6> both = cv::Matx<double, 6, 6>::zeros();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) both(i, j) = both(i + 3, j + 3) = r(i, j);
  }
  const cv::Matx<double, 6, 6> result = both * cv::Matx<double, 6, 6>(covariance.data()) * both.t();
  std::array<double, 36> values{};
  std::copy(result.val, result.val + values.size(), values.begin());
  return values;
}

}  // namespace

std::optional<RosPose> RoadOdometry::add(const FramePose& pose, const std::optional<DisparityPlane>& road) {
  const cv::Matx33d to_world = rotation_of(pose.camera_to_world);
  const cv::Vec3d position = translation_of(pose.camera_to_world);
  auto known = world_to_odom_.find(pose.piece);
  if (known == world_to_odom_.end()) {
    if (!road) return std::nullopt;
    const RoadAxes axes = road_axes(ground_plane(*road, calibration_));
    const cv::Matx33d to_road(axes.x[0], axes.x[1], axes.x[2], axes.y[0], axes.y[1], axes.y[2], axes.z[0], axes.z[1],
                              axes.z[2]);
    const cv::Matx33d turn = to_road * to_world.t();
    const cv::Vec3d foot(axes.origin_m.data());
    known = world_to_odom_.emplace(pose.piece, joined(turn, -(turn * position) - to_road * foot)).first;
  }
  const std::array<double, 12>& world_to_odom = known->second;
  const cv::Matx33d turn = rotation_of(world_to_odom) * to_world;
  const cv::Vec3d moved = rotation_of(world_to_odom) * position + translation_of(world_to_odom);
  return RosPose{joined(turn, moved), turned(pose.covariance, turn)};
}

}  // namespace roadstereo::io
