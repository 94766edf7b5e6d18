#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace roadstereo {

/// A place on the path.
struct PathStation {
  double s_m = 0;
  std::array<double, 2> at_m{};
  std::array<double, 2> ahead{};  ///< unit vector

  std::array<double, 2> beside(double right_m, double forward_m) const {
    return {at_m[0] + forward_m * ahead[0] + right_m * ahead[1], at_m[1] + forward_m * ahead[1] - right_m * ahead[0]};
  }
};

/// The first of the forward_paths() of a path, by distance travelled.
class ForwardPath {
 public:
  explicit ForwardPath(std::span<const std::array<double, 2>> points);

  double length_m() const { return distance_.empty() ? 0 : distance_.back(); }

  /// The place after a distance, with the direction of the metre before and after it. Of a path that has a length.
  PathStation at(double s_m) const;

 private:
  std::size_t end_of_step(double s_m) const;
  std::array<double, 2> point(double s_m) const;

  std::vector<std::array<double, 2>> points_;
  std::vector<double> distance_;
};

}  // namespace roadstereo
