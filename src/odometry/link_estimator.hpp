#pragma once

#include <optional>
#include <vector>

#include "odometry/direct_alignment.hpp"
#include "odometry/ground_patch.hpp"
#include "odometry/reference_points.hpp"
#include "roadstereo/odometry.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// What is kept of a frame that others are aligned with.
struct LinkReference {
  ReferencePoints points;
  std::optional<FrameRoad> road;
  std::vector<float> ground;  ///< of the road's grid, from `sample_ground`
};

/// What is known before a link is estimated.
struct LinkPrior {
  std::optional<RigidMotion> motion;  ///< predicted; absent: unknown
  double yaw_rad = 0;                 ///< of the road, around which phase correlation searches
  OffsetPrior offset;
  double usual_correlation = 0;  ///< of links of this recording; 0: unknown
};

/// Motion between two frames: direct alignment from the predicted motion, from patches of texture found around it, and
/// from where the phase correlation of both road planes, over yaws of ± 8°, has its maxima.
class LinkEstimator {
 public:
  LinkEstimator(const StereoCalibration& calibration, const OdometryOptions& options)
      : calibration_(calibration), options_(options) {}

  const StereoCalibration& calibration() const { return calibration_; }
  const OdometryOptions& options() const { return options_; }

  /// Fills `reference`, whose memory is used again.
  void select(const LinkMaps& maps, const OdometryFrame& frame, LinkReference& reference) const;

  /// Returns the alignment with the best correlation; nullopt if it or the overlap is too small.
  std::optional<Alignment> link(const LinkReference& from, const LinkMaps& maps, const OdometryFrame& frame,
                                const LinkPrior& prior) const;

 private:
  std::vector<RigidMotion> starts(const LinkReference& from, const LinkMaps& maps, const OdometryFrame& frame,
                                  double yaw_rad) const;
  Alignment track(const LinkReference& from, const LinkMaps& maps, const RigidMotion& start,
                  const LinkPrior& prior) const;
  bool accepted(const Alignment& alignment) const;

  StereoCalibration calibration_;
  OdometryOptions options_;
};

/// The link of two frames.
FrameLink frame_link(int from, int to, const Alignment& alignment, const OdometryOptions& options);

// Motions as 3×4 matrices, row-major.
std::array<double, 12> matrix_of(const RigidMotion& motion);
RigidMotion motion_of(const std::array<double, 12>& matrix);

/// Covariance of a pose `motion` after one whose covariance is `c`: A C Aᵀ with the adjoint A of the motion.
std::array<double, 36> carried(const RigidMotion& motion, const std::array<double, 36>& c);

}  // namespace roadstereo
#pragma GCC visibility pop
