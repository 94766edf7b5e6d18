// Rotations and translations against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "odometry/rigid_motion.hpp"

namespace roadstereo {
namespace {

TEST(RigidMotion, QuarterTurnAboutEachAxis) {
  const double quarter = std::numbers::pi / 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Twist twist{1, 2, 3, 0, 0, 0};
    twist[3 + axis] = quarter;
    Vector<3> p{};
    p[(axis + 1) % 3] = 1;  // x to y, y to z, z to x
    const Vector<3> q = rigid_motion(twist)(p);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(q[i], twist[i] + (i == (axis + 2) % 3 ? 1 : 0), 1e-15);
  }
}

TEST(RigidMotion, TwistOfMotionOfTwist) {
  for (const double angle : {0.0, 1e-9, 1e-5, 0.3, 3.0}) {
    const Twist twist{0.1, -0.2, 0.3, angle * 0.6, 0, angle * -0.8};
    const Twist again = twist_of(rigid_motion(twist));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(again[i], twist[i], 1e-14) << angle;
  }
}

TEST(RigidMotion, InverseUndoes) {
  const RigidMotion motion = rigid_motion({1, -2, 0.5, 0.2, 0.3, -0.7});
  const RigidMotion nothing = inverse(motion) * motion;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(nothing.translation[i], 0, 1e-15);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(nothing.rotation[i][j], i == j ? 1 : 0, 1e-15);
  }
}

/// A vehicle that has turned round. R = 2 a aᵀ − 1 of a half turn about a.
TEST(RigidMotion, HalfTurnsAreKept) {
  for (const Vector<3>& axis : {Vector<3>{0, 1, 0}, Vector<3>{0.6, 0.64, 0.48}, Vector<3>{-0.48, 0.6, -0.64}}) {
    RigidMotion motion;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) motion.rotation[i][j] = 2 * axis[i] * axis[j] - (i == j ? 1 : 0);
    }
    for (const double short_of_rad : {0.0, 1e-12, 1e-9, 1e-6, 1e-5, 1e-3}) {
      const double back = -short_of_rad;
      const RigidMotion turned = rigid_motion({0, 0, 0, back * axis[0], back * axis[1], back * axis[2]}) * motion;
      const RigidMotion kept = orthonormal(turned);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(kept.rotation[i][j], turned.rotation[i][j], 1e-11) << back;
      }
      const Twist twist = twist_of(turned);
      EXPECT_NEAR(std::hypot(twist[3], twist[4], twist[5]), std::numbers::pi - short_of_rad, 1e-12);
    }
  }
}

}  // namespace
}  // namespace roadstereo
