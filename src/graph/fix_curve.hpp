#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "graph/hermite.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {

/// Positions between fixes: cubic Hermite spline through them whose tangents are those of the parabola through three
/// neighbours. Altitudes that are unknown are those between the known ones, 0 if none is known.
class FixCurve {
 public:
  FixCurve(std::vector<PositionFix> fixes, double max_gap_s);

  const std::vector<PositionFix>& fixes() const { return fixes_; }
  const Eigen::Vector3d& position(std::size_t fix) const { return positions_[fix]; }

  /// Index of the fix before a time; nullopt outside or in a gap.
  std::optional<std::size_t> segment(double time_s) const;

  /// Position in a segment, which may be left a little. T is double or a jet of Ceres.
  template <class T>
  Eigen::Matrix<T, 3, 1> at(std::size_t segment, const T& time_s) const {
    const std::size_t a = segment, b = segment + 1;
    const double length_s = fixes_[b].time_s - fixes_[a].time_s;
    const T u = (time_s - fixes_[a].time_s) / length_s;
    return hermite(positions_[a], positions_[b], tangents_[a], tangents_[b], length_s, u);
  }

 private:
  void fill_altitudes();

  std::vector<PositionFix> fixes_;
  std::vector<Eigen::Vector3d> positions_, tangents_;
  double max_gap_s_;
};

}  // namespace roadstereo
