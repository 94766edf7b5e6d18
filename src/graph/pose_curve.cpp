#include "graph/pose_curve.hpp"

namespace roadstereo {
namespace {

/// The longest subsequence whose times increase: one wrong time leaves out one pose.
std::vector<TimedPose> in_order_of_time(const std::vector<TimedPose>& poses) {
  std::vector<std::size_t> last_of_length, before(poses.size());  // of each length the pose with the least time
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto at = std::lower_bound(last_of_length.begin(), last_of_length.end(), poses[i].time_s,
                                     [&](std::size_t last, double time_s) { return poses[last].time_s < time_s; });
    before[i] = at == last_of_length.begin() ? i : *(at - 1);
    if (at == last_of_length.end()) {
      last_of_length.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<TimedPose> ordered(last_of_length.size());
  std::size_t i = last_of_length.back();
  for (auto pose = ordered.rbegin(); pose != ordered.rend(); ++pose, i = before[i]) *pose = poses[i];
  return ordered;
}

}  // namespace

PoseCurve::PoseCurve(const std::vector<TimedPose>& poses) : nodes_(in_order_of_time(poses)) {
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> positions;
  for (const TimedPose& pose : nodes_) {
    times_s.push_back(pose.time_s);
    positions.push_back(pose.pose.position);
  }
  tangents_ = parabola_tangents(times_s, positions);
}

bool PoseCurve::covers(double time_s, double max_gap_s) const {
  if (!(time_s >= nodes_.front().time_s && time_s <= nodes_.back().time_s)) return false;
  const std::size_t a = segment(time_s);
  return nodes_.size() == 1 || nodes_[a + 1].time_s - nodes_[a].time_s <= max_gap_s;
}

std::size_t PoseCurve::nearest(double time_s) const {
  const std::size_t a = segment(time_s), b = std::min(a + 1, nodes_.size() - 1);
  return std::abs(nodes_[b].time_s - time_s) < std::abs(nodes_[a].time_s - time_s) ? b : a;
}

}  // namespace roadstereo
