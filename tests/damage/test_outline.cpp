// Where the rim of a hollow lies, whose wall is smoothed.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "damage/outline.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

// A wall of 2.4 cells and a step of 3.2 give one of 4: its rim is a fifth of that from the foot, at 3/25 − 2/125 of the
// depth.
TEST(WallRim, IsWhereTheWallBegan) {
  EXPECT_NEAR(rim_depth_share(4), 0.104, 1e-6);
  EXPECT_EQ(rim_depth_share(3.2), 0.5F) << "a step";
  EXPECT_EQ(rim_depth_share(1), 0.5F);
  EXPECT_LT(rim_depth_share(16), 0.01) << "a gentle wall keeps its foot";
}

/// A hole with walls as steep as can be, seen from above.
TEST(WallRim, AreaOfSteepHoleIsThatOfTheHole) {
  constexpr int side = 320;
  constexpr float depth_px = 2;
  for (const double radius : {20.0, 40.0, 60.0}) {
    Image<float> transformed(side, side, 30.0F);
    for (int v = 0; v < side; ++v) {
      for (int u = 0; u < side; ++u) transformed(u, v) -= std::hypot(u - 160, v - 160) < radius ? depth_px : 0.0F;
    }
    transformed = with_noise(transformed, 0.002);
    const FromAbove above(transformed);
    const DamageMap map = find_damage(above.input);
    ASSERT_EQ(map.damages.size(), 1U);
    const double of_hole = std::numbers::pi * radius * radius;
    EXPECT_NEAR(static_cast<double>(map.damages[0].pixels), of_hole, 0.04 * of_hole) << radius;
  }
}

}  // namespace
}  // namespace roadstereo
