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

}  // namespace
}  // namespace roadstereo
