#pragma once

#include <Eigen/Core>
#include <vector>

#include "evaluate/scan_model.hpp"

namespace roadstereo::cli {

/// A turn and a shift, without reflection.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const { return rotation * point + translation; }
};

/// What the last step of the registration minimises.
enum class LastStep {
  robust,        ///< point to plane, Tukey's weights: what lies far off the surface does not pull
  least_squares  ///< then the mean squared closest distance of all points, which is what is published
};

struct RegistrationOptions {
  double trimmed_share = 0.8;  ///< of the points that rank a start, the nearest, 0.3 … 1
  LastStep last_step = LastStep::robust;

  void validate() const;
};

/// How a cloud lies on a surface.
struct Registration {
  RigidMotion motion;  ///< from the cloud to the surface
  double rms = 0;      ///< what the last step minimises: of the closest distances of the nearest `trimmed_share` of the
                       ///< points, or of all of them after least squares
  double next_rms = 0;  ///< the same of the best other pose, more than 10° or a tenth of the extent away; infinite:
                        ///< every start led here
};

/// Finds the rigid motion from `cloud` to `scan`, wherever both lie: both are laid on their main axes, turned all
/// round and upside down; the best starts are refined. Both must show about the same part of the surface. Always the
/// same result for the same points. Throws Error for fewer than 100 points of the cloud.
Registration register_cloud(const Points& cloud, const ScanModel& scan, const RegistrationOptions& options = {});

}  // namespace roadstereo::cli
