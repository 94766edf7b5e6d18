#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graph/fix_curve.hpp"
#include "graph/graph_pose.hpp"

namespace roadstereo {

/// A frame whose position a fix may tell.
struct TimedPosition {
  std::size_t piece = 0;  ///< of the trajectory, from 0
  double time_s = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the world of its piece
};

/// A piece of the trajectory on the Earth.
struct TrackAlignment {
  double time_offset_s = 0;
  std::vector<std::optional<GraphPose>> pieces;  ///< world of the piece to axes of the Earth; absent: not anchored
  std::string unused;                            ///< why the fixes cannot be used, a sentence; empty: they can
  bool contradicts = false;                      ///< they do not fit
};

/// Time that frames cover: the sum of the steps between them, of `max_gap_s` at most each: a longer one is a pause. NaN
/// are left out.
double recorded_s(std::span<const double> times_s, double max_gap_s);

/// Frames that suffice to align a trajectory, of those with a time: about 500, evenly, but at least 20 of each piece
/// that has so many.
std::vector<TimedPosition> frames_to_align(const std::vector<TimedPosition>& frames);

/// Fits the pieces of a trajectory to fixes: for every time offset the turn about the vertical and the shift of each
/// piece (least squares, once more without what is off by more than three medians); the offset 0 unless another one is
/// far more likely. The pose graph finds smaller offsets.
/// `up` is the vertical in the world of each piece, absent where unknown. Refuses fixes that do not fit, and those that
/// fit only mirrored.
TrackAlignment align_to_track(const std::vector<TimedPosition>& frames,
                              const std::vector<std::optional<Eigen::Vector3d>>& up, const FixCurve& curve,
                              const PoseGraphOptions& options);

}  // namespace roadstereo
