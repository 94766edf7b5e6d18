#include <gtest/gtest.h>

#include "odometry/anderson_acceleration.hpp"

namespace roadstereo {
namespace {

constexpr Matrix<2> metric{{{4, 0}, {1, 2}}};

TEST(AndersonAcceleration, GeometricSequenceEndsAtItsLimit) {
  for (const double ratio : {0.4, -0.7}) {
    AndersonAcceleration<2> acceleration;
    Vector<2> x{3, -5};
    for (int i = 0; i < 2; ++i) {
      const Vector<2> taken = acceleration.accelerated({(ratio - 1) * x[0], (ratio - 1) * x[1]}, metric);
      for (std::size_t k = 0; k < 2; ++k) x[k] += taken[k];
    }
    EXPECT_NEAR(x[0], 0, 1e-12) << ratio;
    EXPECT_NEAR(x[1], 0, 1e-12) << ratio;
  }
}

TEST(AndersonAcceleration, FirstStepIsUnchanged) {
  AndersonAcceleration<2> acceleration;
  EXPECT_EQ(acceleration.accelerated({1, 2}, metric), (Vector<2>{1, 2}));
}

TEST(AndersonAcceleration, GrowingStepsAreNotPrevented) {
  // Steps 1, 2 would come from x = −1 and end there; half of the change, 0.5 · (1 + 1), is the most that is taken off.
  AndersonAcceleration<2> acceleration;
  acceleration.accelerated({1, 0}, metric);
  const Vector<2> taken = acceleration.accelerated({2, 0}, metric);
  EXPECT_EQ(taken, (Vector<2>{1, 0}));
}

}  // namespace
}  // namespace roadstereo
