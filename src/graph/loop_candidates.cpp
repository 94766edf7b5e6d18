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

constexpr double overlapping = 0.7, deviations = 3;
constexpr std::size_t stretch_length = 64;

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

LoopPlaces::LoopPlaces(const std::vector<KeyframeView>& views, const Trajectory& odometry, const Trajectory& best) {
  for (const KeyframeView& view : views) {
    const FramePose& pose = pose_of(best, view.frame);
    places_.push_back({&view, &pose_of(odometry, view.frame), &pose, motion_of(pose.camera_to_world)(view.centre_m),
                       point_variance(pose.covariance, view.centre_m)});
  }
  for (std::size_t first = 0; first < places_.size(); first += stretch_length) stretches_.push_back(stretch_of(first));
}

LoopPlaces::Stretch LoopPlaces::stretch_of(std::size_t first) const {
  const std::size_t end = std::min(first + stretch_length, places_.size());
  Stretch stretch;
  stretch.centre = places_[(first + end) / 2].centre;
  for (std::size_t i = first; i < end; ++i) {
    stretch.radius_m = std::max(stretch.radius_m, distance(places_[i].centre, stretch.centre));
    stretch.view_radius_m = std::max(stretch.view_radius_m, places_[i].view->radius_m);
    stretch.variance = std::max(stretch.variance, places_[i].variance);
  }
  return stretch;
}

/// Standard error of the position of what a keyframe shows against another.
double LoopPlaces::relative_deviation(const Place& from, const Place& to) {
  double variance = from.variance + to.variance;
  const FramePose &c = *from.odometry, &d = *to.odometry;
  if (c.piece == d.piece) {
    const RigidMotion motion = inverse(motion_of(d.camera_to_world)) * motion_of(c.camera_to_world);
    std::array<double, 36> added = d.covariance;
    const std::array<double, 36> before = carried(motion, c.covariance);
    for (std::size_t i = 0; i < added.size(); ++i) added[i] -= before[i];
    variance = std::min(variance, std::max(point_variance(added, to.view->centre_m), 0.0));
  }
  return std::sqrt(variance);
}

/// Whether a keyframe may show the place of another. The links are asked last, since that takes longest.
bool LoopPlaces::is_near(const Place& from, const Place& to, double distance_m) {
  if (from.best->piece != to.best->piece) return false;
  const double view_m = overlapping * (to.view->radius_m + from.view->radius_m);
  return distance_m < view_m + deviations * std::sqrt(from.variance + to.variance) &&
         distance_m < view_m + deviations * relative_deviation(from, to);
}

/// Whether no keyframe of a stretch is near, whatever the links say.
bool LoopPlaces::is_far(const Stretch& stretch, const Place& to) {
  constexpr double rounding = 1e-9;
  const double distance_m = distance(to.centre, stretch.centre);
  const double reach_m = overlapping * (to.view->radius_m + stretch.view_radius_m) +
                         deviations * std::sqrt(stretch.variance + to.variance) + stretch.radius_m;
  return distance_m > (1 + rounding) * reach_m;
}

/// Number of keyframes up to the last one before the camera came to the place of `current`.
std::size_t LoopPlaces::left_before(std::size_t current) const {
  const Place& here = places_[current];
  std::size_t count = current;
  const auto is_left = [&](const Place& place) {
    return place.best->piece == here.best->piece &&
           distance(here.centre, place.centre) > here.view->radius_m + place.view->radius_m;
  };
  while (count > 0 && !is_left(places_[count - 1])) --count;
  return count;
}

std::vector<LoopCandidates> LoopPlaces::visits(std::size_t current) const {
  constexpr std::size_t most_visits = 3;
  const Place& here = places_[current];
  std::vector<LoopCandidates> visits;
  std::vector<Near> run;
  const auto end_run = [&] {
    if (run.empty()) return;
    const std::size_t before = std::max<std::size_t>(run.back().index, 1) - 1;
    visits.push_back(chosen(std::exchange(run, {}), here.view->radius_m + places_[before].view->radius_m));
  };
  for (std::size_t end = left_before(current); end > 0 && visits.size() < most_visits;) {
    const std::size_t first = (end - 1) / stretch_length * stretch_length;
    if (is_far(stretches_[first / stretch_length], here)) {
      end = first;
      end_run();
    }
    for (; end > first && visits.size() < most_visits; --end) {
      const Place& other = places_[end - 1];
      const double distance_m = distance(here.centre, other.centre);
      if (is_near(other, here, distance_m)) {
        run.push_back({end - 1, distance_m, other.centre});
      } else {
        end_run();
      }
    }
  }
  end_run();
  return visits;
}

}  // namespace roadstereo
