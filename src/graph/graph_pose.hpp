#pragma once

#include <Eigen/Geometry>
#include <array>

namespace roadstereo {

/// Pose of a camera in the world, as a solver has it.
struct GraphPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

using PoseMatrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

inline GraphPose graph_pose(const std::array<double, 12>& values) {
  const Eigen::Map<const PoseMatrix> matrix(values.data());
  return {matrix.col(3), Eigen::Quaterniond(matrix.leftCols<3>().eval()).normalized()};
}

inline std::array<double, 12> matrix_of(const GraphPose& pose) {
  std::array<double, 12> values{};
  Eigen::Map<PoseMatrix> matrix(values.data());
  matrix.leftCols<3>() = pose.rotation.toRotationMatrix();
  matrix.col(3) = pose.position;
  return values;
}

/// Does `first`, then `second`.
inline GraphPose operator*(const GraphPose& second, const GraphPose& first) {
  return {second.rotation * first.position + second.position, (second.rotation * first.rotation).normalized()};
}

inline GraphPose inverse(const GraphPose& pose) {
  const Eigen::Quaterniond back = pose.rotation.conjugate();
  return {-(back * pose.position), back};
}

}  // namespace roadstereo
