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

/// Finds where a trajectory comes back to. `best` are its poses as far as they are known, `odometry` those of the links
/// alone; all three must outlive it.
class LoopPlaces {
 public:
  /// Throws Error naming the frame of a view that a trajectory lacks.
  LoopPlaces(const std::vector<KeyframeView>& views, const Trajectory& odometry, const Trajectory& best);

  /// Visits of the place that keyframe `current` shows, each a run of keyframes before it, after the camera had left
  /// the place: views that overlap by more than 30 %, or may do so within three standard errors of the relative
  /// position. Those are at most the sum of both poses' own (`best`), and that of the links between them (`odometry`).
  std::vector<LoopCandidates> visits(std::size_t current) const;

 private:
  /// A keyframe in the world.
  struct Place {
    const KeyframeView* view = nullptr;
    const FramePose *odometry = nullptr, *best = nullptr;
    std::array<double, 3> centre{};
    double variance = 0;  ///< of the centre
  };
  /// A ball around the centres of successive keyframes, and the largest values of one.
  struct Stretch {
    std::array<double, 3> centre{};
    double radius_m = 0, view_radius_m = 0, variance = 0;
  };

  static double relative_deviation(const Place& from, const Place& to);
  static bool is_near(const Place& from, const Place& to, double distance_m);
  static bool is_far(const Stretch& stretch, const Place& to);
  std::size_t left_before(std::size_t current) const;
  Stretch stretch_of(std::size_t first) const;

  std::vector<Place> places_;
  std::vector<Stretch> stretches_;  ///< of `stretch_length` keyframes each
};

}  // namespace roadstereo
