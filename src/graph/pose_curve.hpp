#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "graph/graph_pose.hpp"
#include "graph/hermite.hpp"

namespace roadstereo {

/// A frame on its way.
struct TimedPose {
  double time_s = 0;
  std::size_t frame = 0;
  GraphPose pose;
};

/// Poses of a piece of the trajectory between its frames: positions by a cubic Hermite spline, rotations at constant
/// rate. Before the first and after the last frame the motion goes on as it is there.
class PoseCurve {
 public:
  /// Leaves out as few poses as possible whose times are not in order. There must be a pose.
  explicit PoseCurve(const std::vector<TimedPose>& poses);

  const std::vector<TimedPose>& nodes() const { return nodes_; }

  /// Whether a time is between two frames that are not farther apart than `max_gap_s`.
  bool covers(double time_s, double max_gap_s) const;

  /// Index of the node that is nearest in time.
  std::size_t nearest(double time_s) const;

  /// Where a point of the camera's axes is at a time, in the axes that the camera of a node has there. T is double or a
  /// jet of Ceres.
  template <class T>
  Eigen::Matrix<T, 3, 1> seen_from(std::size_t node, const T& time_s, const Eigen::Matrix<T, 3, 1>& point) const {
    const GraphPose& base = nodes_[node].pose;
    const Eigen::Quaternion<T> back = base.rotation.conjugate().cast<T>();
    const std::size_t a = segment(time_s), b = std::min(a + 1, nodes_.size() - 1);
    const Eigen::Matrix<T, 3, 1> away = position_at(a, b, time_s) - base.position.cast<T>();
    return back * (away + rotation_at(a, b, time_s) * point).eval();
  }

 private:
  template <class T>
  std::size_t segment(const T& time_s) const {
    if (nodes_.size() < 2) return 0;
    const auto after = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, time_s,
                                        [](const T& time, const TimedPose& node) { return time < node.time_s; });
    return static_cast<std::size_t>(after - nodes_.begin()) - 1;
  }

  template <class T>
  Eigen::Matrix<T, 3, 1> position_at(std::size_t a, std::size_t b, const T& time_s) const {
    const TimedPose &from = nodes_[a], &to = nodes_[b];
    const std::size_t end = time_s < from.time_s || a == b ? a : b;
    if (end == a || time_s > to.time_s) {  // outside
      const T beyond_s = time_s - nodes_[end].time_s;
      return nodes_[end].pose.position.cast<T>() + tangents_[end].cast<T>() * beyond_s;
    }
    const double length_s = to.time_s - from.time_s;
    const T u = (time_s - from.time_s) / length_s;
    return hermite(from.pose.position, to.pose.position, tangents_[a], tangents_[b], length_s, u);
  }

  template <class T>
  Eigen::Quaternion<T> rotation_at(std::size_t a, std::size_t b, const T& time_s) const {
    using std::cos;
    using std::sin;
    Eigen::Quaternion<T> from = nodes_[a].pose.rotation.cast<T>();
    if (a == b) return from;
    const Eigen::AngleAxisd turn(nodes_[a].pose.rotation.conjugate() * nodes_[b].pose.rotation);
    const double half_rate = 0.5 * turn.angle() / (nodes_[b].time_s - nodes_[a].time_s);
    const T half = (time_s - nodes_[a].time_s) * half_rate, sine = sin(half);
    const Eigen::Vector3d& axis = turn.axis();
    return from * Eigen::Quaternion<T>(cos(half), sine * axis.x(), sine * axis.y(), sine * axis.z());
  }

  std::vector<TimedPose> nodes_;
  std::vector<Eigen::Vector3d> tangents_;
};

}  // namespace roadstereo
