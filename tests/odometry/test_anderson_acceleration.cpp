#include <gtest/gtest.h>

#include "odometry/anderson_acceleration.hpp"

namespace roadstereo {
namespace {

constexpr Matrix<2> metric{{{4, 99}, {1, 2}}};  // the upper half is not read

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

TEST(AndersonAcceleration, LengthsAreThoseOfMetric) {
  // The change (−1, 1) has the square 4 − 2·1 + 2 = 4 and the product −1 + 2 = 1 with the step: a share of a quarter.
  AndersonAcceleration<2> acceleration;
  EXPECT_EQ(acceleration.accelerated({1, 0}, metric), (Vector<2>{1, 0}));
  EXPECT_EQ(acceleration.accelerated({0, 1}, metric), (Vector<2>{0, 0.75}));
}

TEST(AndersonAcceleration, SlowStepsAreThreeTimesAsLong) {
  AndersonAcceleration<2> acceleration;
  acceleration.accelerated({0.1, 0}, metric);
  EXPECT_NEAR(acceleration.accelerated({0.09, 0}, metric)[0], 0.27, 1e-12);
}

TEST(AndersonAcceleration, GrowingStepsAreTakenAsTheyAre) {
  AndersonAcceleration<2> acceleration;
  acceleration.accelerated({1, 0}, metric);
  EXPECT_EQ(acceleration.accelerated({2, 0}, metric), (Vector<2>{2, 0}));
}

}  // namespace
}  // namespace roadstereo
