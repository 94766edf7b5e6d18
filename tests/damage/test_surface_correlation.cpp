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
  input.misalignment.rows_px = rows;
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) EXPECT_GT(damage.evidence.surface_significance, 3);
}

TEST(DamageEvidence, SurfaceThatPicturesContradictIsNoDamage) {
  // The log-odds of −9.8 + 2.15·ln 50 + 4.4 fall by 4.7·(1.85 + 0.15) = 9.4.
  const double before = -9.8 + 2.15 * std::log(50) + 4.4;
  DamageEvidence evidence{20, 50, 3, 1, 0};
  evidence.surface_significance = -0.15;
  EXPECT_NEAR(evidence.confidence(), 1 / (1 + std::exp(9.4 - before)), 1e-4);
  EXPECT_NEAR((DamageEvidence{20, 50, 3, 1, 0}.confidence()), 1 / (1 + std::exp(-before)), 1e-4);
}

// They rise by 4.7·(1.9 − 1.85), and by 0.5 at most: what both pictures see may still be no damage.
TEST(DamageEvidence, SurfaceThatPicturesConfirmIsLittleEvidence) {
  const double before = -9.8 + 2.15 * std::log(50) + 4.4;
  DamageEvidence evidence{20, 50, 3, 1, 0};
  for (const auto& [significance, added] : {std::pair{1.9, 0.235}, std::pair{2.5, 0.5}, std::pair{30.0, 0.5}}) {
    evidence.surface_significance = significance;
    EXPECT_NEAR(evidence.confidence(), 1 / (1 + std::exp(-before - added)), 1e-4) << significance;
  }
}

}  // namespace
}  // namespace roadstereo
