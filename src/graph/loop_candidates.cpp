#include "graph/loop_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "odometry/link_estimator.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {

const FramePose& pose_of(const Trajectory& trajectory, int frame) {
  const auto pose = std::lower_bound(trajectory.frames.begin(), trajectory.frames.end(), frame,
                                     [](const FramePose& one, int index) { return one.frame < index; });
  if (pose == trajectory.frames.end() || pose->frame != frame) {
    fail("loop search: frame ", frame, " is not in the trajectory of ", trajectory.frames.size(), " frames");
  }
  return *pose;
}

namespace {

/// Variance of the position of a point of the camera, from the covariance of its pose.
double point_variance(const std::array<double, 36>& covariance, const Vector<3>& point) {
  // The point moves by t + ω × p.
  const Matrix<3> lever{{{0, point[2], -point[1]}, {-point[2], 0, point[0]}, {point[1], -point[0], 0}}};
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector<6> row{};
    row[axis] = 1;
    for (std::size_t k = 0; k < 3; ++k) row[3 + k] = lever[axis][k];
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) sum += row[i] * covariance[6 * i + j] * row[j];
    }
  }
  return sum;
}

/// Standard error of the position of what a keyframe shows against another.
double relative_deviation(const KeyframeView& from, const KeyframeView& to, const Trajectory& odometry,
                          const Trajectory& best) {
  const FramePose &a = pose_of(best, from.frame), &b = pose_of(best, to.frame);
  double variance = point_variance(a.covariance, from.centre_m) + point_variance(b.covariance, to.centre_m);
  const FramePose &c = pose_of(odometry, from.frame), &d = pose_of(odometry, to.frame);
  if (c.piece == d.piece) {
    const RigidMotion motion = inverse(motion_of(d.camera_to_world)) * motion_of(c.camera_to_world);
    std::array<double, 36> added = d.covariance;
    const std::array<double, 36> before = carried(motion, c.covariance);
    for (std::size_t i = 0; i < added.size(); ++i) added[i] -= before[i];
    variance = std::min(variance, std::max(point_variance(added, to.centre_m), 0.0));
  }
  return std::sqrt(variance);
}

/// A keyframe of a run.
struct Near {
  std::size_t index = 0;
  double distance_m = 0;
  Vector<3> centre{};
};

double distance(const Vector<3>& a, const Vector<3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The nearest, then others at least a view apart, as far as the place is uncertain.
LoopCandidates chosen(std::vector<Near> run, double apart_m) {
  constexpr std::size_t most = 4;
  std::stable_sort(run.begin(), run.end(), [](const Near& a, const Near& b) { return a.distance_m < b.distance_m; });
  LoopCandidates result;
  std::vector<Vector<3>> taken;
  for (const Near& near : run) {
    if (result.size() == most) break;
    if (std::any_of(taken.begin(), taken.end(),
                    [&](const auto& other) { return distance(near.centre, other) < apart_m; }))
      continue;
    result.push_back(near.index);
    taken.push_back(near.centre);
  }
  return result;
}

}  // namespace

std::vector<LoopCandidates> loop_candidates(const std::vector<KeyframeView>& views, std::size_t current,
                                            const Trajectory& odometry, const Trajectory& best) {
  constexpr double overlapping = 0.7, deviations = 3;
  constexpr std::size_t most_visits = 3;
  const KeyframeView& here = views[current];
  const FramePose& pose = pose_of(best, here.frame);
  const Vector<3> centre = motion_of(pose.camera_to_world)(here.centre_m);
  std::vector<LoopCandidates> visits;
  std::vector<Near> run;
  bool left = false;
  for (std::size_t i = current; i-- > 0 && visits.size() < most_visits;) {
    const FramePose& other = pose_of(best, views[i].frame);
    const Vector<3> seen = motion_of(other.camera_to_world)(views[i].centre_m);
    const double reach_m = here.radius_m + views[i].radius_m, distance_m = distance(centre, seen);
    const bool same_world = other.piece == pose.piece;
    left = left || (same_world && distance_m > reach_m);
    const double uncertain_m = left && same_world ? deviations * relative_deviation(views[i], here, odometry, best) : 0;
    const bool is_near = left && same_world && distance_m < overlapping * reach_m + uncertain_m;
    if (is_near) run.push_back({i, distance_m, seen});
    if (!run.empty() && (!is_near || i == 0)) visits.push_back(chosen(std::exchange(run, {}), reach_m));
  }
  return visits;
}

}  // namespace roadstereo
