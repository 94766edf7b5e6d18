// What the grey levels of both pictures say of a surface that the disparities claim.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// The pictures of the damaged scene with its exact maps, and a hollow that the disparities claim where there is none.
struct ClaimedHollow {
  static constexpr double u = 320, v = 300, radius_px = 14, depth_px = 1.5;
  GreyImage left, right;
  Image<float> disparity = damaged().disparity, transformed = damaged().transformed;

  ClaimedHollow() {
    to_grey(damaged().pair.left.view(), 255, left);
    to_grey(damaged().pair.right.view(), 255, right);
    for (int y = 0; y < disparity.height(); ++y) {
      for (int x = 0; x < disparity.width(); ++x) {
        const double share = 1 - std::hypot(x - u, y - v) / radius_px;
        const auto depth = static_cast<float>(depth_px * std::clamp(2 * share, 0.0, 1.0));
        disparity(x, y) -= depth;
        transformed(x, y) -= depth;
      }
    }
  }

  DamageInput input() const {
    DamageInput input = damaged().metric();
    input.transformed = transformed;
    input.disparity = disparity;
    input.grey = left;
    return input;
  }
};

int ids_at_hollow(const DamageMap& map) {
  return map.ids(static_cast<int>(ClaimedHollow::u), static_cast<int>(ClaimedHollow::v));
}

TEST(SurfaceCorrelation, HollowThatNoPictureShowsIsNone) {
  const ClaimedHollow claimed;
  DamageInput input = claimed.input();
  const DamageMap by_map = find_damage(input);
  EXPECT_EQ(by_map.damages.size(), 3U);
  EXPECT_NE(ids_at_hollow(by_map), 0);
  EXPECT_TRUE(std::isnan(by_map.damages[0].evidence.surface_significance));
  input.right = claimed.right;
  const DamageMap by_pictures = find_damage(input);
  ASSERT_EQ(by_pictures.damages.size(), 2U);
  EXPECT_EQ(ids_at_hollow(by_pictures), 0);
  for (const Damage& damage : by_pictures.damages) EXPECT_GT(damage.evidence.surface_significance, 3);
}

TEST(SurfaceCorrelation, RowOffsetIsUndone) {
  const ClaimedHollow claimed;
  constexpr int rows = 2;
  GreyImage lower(claimed.right.width(), claimed.right.height());
  for (int v = 0; v < lower.height(); ++v) {
    std::copy_n(claimed.right.row(std::max(0, v - rows)), lower.width(), lower.row(v));
  }
  DamageInput input = claimed.input();
  input.right = lower;
  input.shift.emplace().misalignment.rows_px = rows;
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) EXPECT_GT(damage.evidence.surface_significance, 3);
}

/// The rig's bias is no part of the disparities, but the right picture is found with it.
TEST(SurfaceCorrelation, RigBiasIsAddedBack) {
  const ClaimedHollow claimed;
  constexpr float bias_px = 0.7F;
  DamageInput input = damaged().metric();
  input.grey = claimed.left;
  input.right = claimed.right;
  const DamageMap without = find_damage(input);
  Image<float> corrected = damaged().disparity;
  for (std::size_t k = 0; k < corrected.pixels(); ++k) corrected.row(0)[k] -= bias_px;
  input.disparity = corrected;
  input.matched = damaged().disparity;
  input.plane->a0 -= bias_px;
  const DamageMap with = find_damage(input);
  ASSERT_EQ(without.damages.size(), 2U);
  ASSERT_EQ(with.damages.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const double expected = without.damages[k].evidence.surface_significance;
    EXPECT_NEAR(with.damages[k].evidence.surface_significance, expected, 0.05 * expected);
  }
}

TEST(DamageEvidence, SurfaceThatPicturesContradictIsNoDamage) {
  DamageEvidence evidence{20, 90, 3, 1, 0};
  EXPECT_GT(evidence.confidence(), 0.95);
  evidence.surface_significance = -0.15;
  EXPECT_LT(evidence.confidence(), 0.05);
}

// What both pictures see may still be no damage: the odds rise to the double at most.
TEST(DamageEvidence, SurfaceThatPicturesConfirmIsLittleEvidence) {
  DamageEvidence evidence{20, 50, 3, 1, 0};
  const auto odds = [&evidence] { return evidence.confidence() / (1 - evidence.confidence()); };
  const double unknown = odds();
  evidence.surface_significance = 3;
  EXPECT_GT(odds(), unknown);
  EXPECT_LT(odds(), 2 * unknown);
  const double confirmed = odds();
  evidence.surface_significance = 30;
  EXPECT_NEAR(odds(), confirmed, 1e-9 * confirmed);
}

// What rises may be a kerb or a car with a surface of its own; a hollow that the pictures confirm is rarely anything
// else.
TEST(DamageEvidence, HollowThatPicturesConfirmIsDamage) {
  DamageEvidence evidence{6, 6, 3, 1, 0};
  evidence.likely_wall_slope = 0.4;
  EXPECT_LT(evidence.confidence(), 0.25);
  evidence.surface_significance = 3;
  EXPECT_GT(evidence.confidence(), 0.4);
  const double confirmed = evidence.confidence();
  evidence.surface_significance = 30;
  EXPECT_GT(evidence.confidence(), confirmed);
  EXPECT_LT(evidence.confidence(), 0.8) << "two standard errors count";
}

// What is wider than half of a straightedge may be the shape of the road.
TEST(DamageEvidence, ExtentCountsBeyondReachOfSurface) {
  DamageEvidence evidence{20, 40, 3, 1, 0};
  const double unknown = evidence.confidence();
  evidence.extent = 1;
  EXPECT_EQ(evidence.confidence(), unknown);
  evidence.extent = 2;
  EXPECT_LT(evidence.confidence(), 0.3);
}

}  // namespace
}  // namespace roadstereo
