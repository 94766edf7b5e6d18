#include "graph/pose_curve.hpp"

namespace roadstereo {

PoseCurve::PoseCurve(const std::vector<TimedPose>& poses) {
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> positions;
  for (const TimedPose& pose : poses) {
    if (!nodes_.empty() && !(pose.time_s > nodes_.back().time_s)) continue;
    nodes_.push_back(pose);
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
