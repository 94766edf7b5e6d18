#pragma once

#include <Eigen/Core>
#include <vector>

#include "evaluate/scan_model.hpp"

namespace roadstereo::cli {

/// Rotation and translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const { return rotation * point + translation; }
};

/// Last step of the registration.
enum class LastStep {
  robust,        ///< point-to-plane ICP with Tukey weights, robust against outliers
  least_squares  ///< robust, then point-to-point ICP of all points, which minimises the published measure
};

/// Result of a registration.
struct Registration {
  RigidMotion motion;   ///< from the cloud to the surface
  double rms = 0;       ///< of the closest distances: of the nearest 80 % of the points, or of all of them
                        ///< after least squares
  double next_rms = 0;  ///< the same for the best pose that differs by more than 10° or a tenth of the extent; infinity
                        ///< if all initial poses converge to one
};

/// Global registration of a cloud to a scan: trimmed ICP (iterative closest points) from 72 initial poses, which align
/// the principal axes, then robust point-to-plane ICP of the best. Both must show about the same part of the surface.
/// Deterministic. Throws Error for fewer than 100 points in the cloud.
Registration register_cloud(const Points& cloud, const ScanModel& scan, LastStep last = LastStep::robust);

}  // namespace roadstereo::cli
