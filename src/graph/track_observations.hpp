#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "graph/fix_curve.hpp"
#include "graph/pose_curve.hpp"

namespace roadstereo {

/// A position of the track and the camera at its time: that of a frame nearby, moved as the odometry has it.
struct TrackObservation {
  const PoseCurve* way = nullptr;
  std::size_t node = 0;                                  ///< of `way`
  double time_s = 0;                                     ///< by the receiver's clock
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the antenna
  double horizontal_sd_m = 0, vertical_sd_m = 0;
  bool has_z = false;
  bool interpolated = false;  ///< between two fixes, at the time of a frame

  std::size_t frame() const { return way->nodes()[node].frame; }

  /// Position of the antenna, from the pose of `frame`. T is double or a jet of Ceres.
  template <class T>
  Eigen::Matrix<T, 3, 1> antenna(const Eigen::Matrix<T, 3, 1>& position, const Eigen::Quaternion<T>& rotation,
                                 const Eigen::Matrix<T, 3, 1>& lever_arm, const T& time_offset_s) const {
    return rotation * way->seen_from(node, T(time_s - time_offset_s), lever_arm) + position;
  }
};

/// Positions of the track along pieces of the trajectory: the fixes that are between frames not farther apart than
/// `max_gap_s` at the time offset `covered_offset_s`, at the time offset `time_offset_s`, which may be another one.
/// A piece with fewer than three of them has, at the times of its frames, the positions between fixes. The observations
/// point to the pieces.
std::vector<TrackObservation> observe_track(const std::vector<PoseCurve>& pieces, const FixCurve& curve,
                                            double time_offset_s, double covered_offset_s, double max_gap_s);

}  // namespace roadstereo
