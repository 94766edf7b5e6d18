#pragma once

#include "odometry/reference_points.hpp"
#include "odometry/rigid_motion.hpp"
#include "roadstereo/calibration.hpp"

namespace roadstereo {

/// What is known of the disparity offset at infinity before an alignment.
struct OffsetPrior {
  double mean_px = 0;
  double sd_px = 0;  ///< 0: known
};

/// Motion between two frames.
struct Alignment {
  RigidMotion motion;      ///< from the camera frame of the reference to that of the current frame
  Matrix<6> covariance{};  ///< of the motion: translation, then rotation vector, in the current camera frame
  double overlap = 0;      ///< share of the points of the reference that the current frame sees; what it sees from
                           ///< farther away counts by the smaller area
  double correlation = 0;  ///< median NCC of patches of texture; about 0 for a wrong motion
  double offset_px = 0;    ///< disparity offset at infinity that was assumed or estimated
  double offset_sd_px = 0;
  double measured_offset_px = 0;  ///< what the frames say of it, whatever was known before
  double measured_offset_sd_px = 0;
  double rig_offset_px = 0;  ///< at the principal point, with a free offset and shutter
  double rig_offset_sd_px = 0;
  double shutter = 0;  ///< time from the first row to the last, by that between both frames
  double shutter_sd = 0;
};

/// Scale of the disparity offset at column u: a right camera that is yawed by θ shifts disparities by f·θ·(1 + x²), x
/// in the right camera, whose principal point is at cx + doffs.
inline double offset_shape(const StereoCalibration& calibration, double u, double disparity_px) {
  const double x = (u - disparity_px - calibration.cx_px - calibration.disparity_offset_px) / calibration.focal_px;
  return 1 + x * x;
}

/// Aligns a frame with the points of a reference: Gauss–Newton, accelerated, over six degrees of freedom, gain, offset
/// of the grey levels and offset of the disparities, coarse to fine, on differences of grey levels and of disparities.
/// Both are weighted by their variances (M-estimator, Tukey's biweight); those of grey levels include the standard
/// error of the depth. The covariance is the sandwich of cells of the image, whose residuals may be correlated. `start`
/// is a first guess; `coarsest` the first level of the pyramid, `finest` the last. It runs on up to
/// `threads` threads (0: all cores); the result does not depend on how many.
Alignment align(const ReferencePoints& reference, const LinkMaps& current, const StereoCalibration& calibration,
                const RigidMotion& start, const OffsetPrior& offset, int coarsest, int finest, int threads);

}  // namespace roadstereo
