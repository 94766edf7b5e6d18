#pragma once

#include "odometry/reference_points.hpp"
#include "odometry/rigid_motion.hpp"

namespace roadstereo {

/// Searches the patches of one level of the pyramid in a frame, up to `radius` pixels of the level from where `start`
/// moves them, by NCC, and returns the motion that explains the most of them: perspective-n-point by Gauss–Newton with
/// Tukey's biweight, every patch weighted by its structure tensor. Returns `start` when too few are found.
RigidMotion match_patches(const ReferencePoints& reference, const LinkMaps& current,
                          const StereoCalibration& calibration, const RigidMotion& start, double offset_px, int level,
                          int radius);

/// Median NCC of the patches of level 1 with the frame where the motion puts them, of the nearer or of the farther
/// half, whichever is smaller: far ones tell a wrong rotation, near ones a wrong translation. About 0 for a wrong
/// motion.
double patch_correlation(const ReferencePoints& reference, const LinkMaps& current,
                         const StereoCalibration& calibration, const RigidMotion& motion, double offset_px);

}  // namespace roadstereo
