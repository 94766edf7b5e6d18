// Regions that are noise, around each damage.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "damage/clutter.hpp"

namespace roadstereo {
namespace {

Damage region(DamageKind kind, double confidence) {
  Damage damage;
  damage.kind = kind;
  damage.confidence = confidence;
  damage.evidence = {20, 60, 2, 1, 0};
  return damage;
}

// Hollows: 0.1 + 0.8 + 0.9 of them are noise; bumps: 0.7, since 0.04 is too little to be listed.
TEST(Clutter, IsTwiceTheRarerKindOfNoise) {
  std::vector<Damage> damages{region(DamageKind::depression, 0.9), region(DamageKind::depression, 0.2),
                              region(DamageKind::depression, 0.1), region(DamageKind::protrusion, 0.3),
                              region(DamageKind::protrusion, 0.04)};
  add_clutter(damages);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(damages[k].evidence.clutter, 2 * 0.7, 1e-12) << k;
  EXPECT_EQ(damages[3].evidence.clutter, 0) << "the only bump";
  EXPECT_NEAR(damages[4].evidence.clutter, 2 * 0.7, 1e-12);
}

// A road that is full of shallow hollows is damaged, not noisy.
TEST(Clutter, HollowsAloneAreNone) {
  std::vector<Damage> damages(12, region(DamageKind::depression, 0.3));
  add_clutter(damages);
  for (const Damage& damage : damages) EXPECT_EQ(damage.evidence.clutter, 0);
  std::vector<Damage> none;
  add_clutter(none);
  EXPECT_TRUE(none.empty());
}

// Among n regions that are noise the odds of damage are those of one divided by n − 1; two are usual.
TEST(Clutter, DividesOdds) {
  const auto odds = [](const Damage& damage) { return damage.confidence / (1 - damage.confidence); };
  std::vector<Damage> alone{region(DamageKind::depression, 0.9)};
  add_clutter(alone);
  std::vector<Damage> among = alone;
  for (int k = 0; k < 3; ++k) {
    among.push_back(region(DamageKind::depression, 0.25));
    among.push_back(region(DamageKind::protrusion, 0.25));
  }
  add_clutter(among);
  EXPECT_NEAR(among[0].evidence.clutter, 4.5, 1e-12);
  EXPECT_NEAR(odds(alone[0]) / odds(among[0]), 3.5, 1e-9);
  among.resize(3);
  among[0] = alone[0];
  add_clutter(among);
  EXPECT_EQ(among[0].confidence, alone[0].confidence) << "one hollow and one bump";
}

}  // namespace
}  // namespace roadstereo
