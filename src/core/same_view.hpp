#pragma once

#include <cmath>

#include "roadstereo/rigid_transform.hpp"

namespace roadstereo {

/// Whether two frames show the road as from one place: the camera, with these poses in the world at this height above
/// the road, has moved by less than a hundredth of the height and turned by less than a hundredth of a radian, about
/// ten pixels of the picture or a support window. The errors of its heights are the same then.
inline bool is_same_view(const RigidTransform& one, const RigidTransform& other, double height_m) {
  constexpr double share = 0.01;
  const RigidTransform motion = compose(inverse(one), other);
  const double trace = motion[0] + motion[5] + motion[10];
  return std::hypot(motion[3], motion[7], motion[11]) < share * height_m && trace > 1 + 2 * std::cos(share);
}

}  // namespace roadstereo
