#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "roadstereo/trajectory.hpp"

namespace roadstereo {

/// Pose of a frame. Throws Error naming it if the trajectory lacks it.
const FramePose& pose_of(const Trajectory& trajectory, int frame);

/// What a keyframe shows of the road.
struct KeyframeView {
  int frame = 0;
  std::array<double, 3> centre_m{};  ///< in the middle of the image, camera axes
  double radius_m = 0;               ///< half of the shorter side of the view
};

/// Earlier keyframes that may show what one shows: one visit of the place, the likeliest first.
using LoopCandidates = std::vector<std::size_t>;

/// Visits of the place that keyframe `current` shows, each a run of keyframes before it, after the camera had left the
/// place: views that overlap by more than 30 %, or may do so within three standard errors of the relative position.
/// Those are at most the sum of both poses' own (`best`), and that of the links between them (`odometry`).
std::vector<LoopCandidates> loop_candidates(const std::vector<KeyframeView>& views, std::size_t current,
                                            const Trajectory& odometry, const Trajectory& best);

}  // namespace roadstereo
