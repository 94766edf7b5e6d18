#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace roadstereo::cli {

/// Way of a camera over the road in bounded memory: points at least a step apart. When there are too many, every other
/// one goes and the step doubles.
class CameraPath {
 public:
  static constexpr std::size_t max_points = 1000;

  /// Adds the next position, metres.
  void add(double x_m, double y_m);

  /// Begins anew.
  void clear();

  /// The kept points and the last position.
  std::vector<std::array<double, 2>> points_m() const;

  /// Length of the way, metres, along all positions.
  double length_m() const { return length_m_; }

 private:
  static constexpr double finest_step_m = 0.02;

  std::vector<std::array<double, 2>> kept_;
  std::array<double, 2> last_{};
  double step_m_ = finest_step_m;
  double length_m_ = 0;
};

}  // namespace roadstereo::cli
