// Profiles across a lane that leads along y, and a pothole 2 m along it.
#include <gtest/gtest.h>

#include <numbers>

#include "map/rut_profiles.hpp"

namespace roadstereo {
namespace {

TransverseProfile profile_at(double y, double rut_m) {
  TransverseProfile profile;
  profile.at_m = {0, y};
  profile.heading_rad = std::numbers::pi / 2;
  profile.rut_depth_m.value = rut_m;
  profile.rut_noise_floor_m = 0.001;
  return profile;
}

/// 0.4 m × 0.4 m around (x, y), in cells of 2 cm.
RoadDamageRecord damage_at(double x, double y, Distress distress) {
  RoadDamageRecord record;
  record.best.damage.metrics.emplace();
  record.best.damage.metrics->distress = distress;
  for (int j = -10; j < 10; ++j) {
    for (int i = -10; i < 10; ++i) {
      record.best.footprint.push_back({static_cast<int>(x / 0.02) + i, static_cast<int>(y / 0.02) + j});
    }
  }
  return record;
}

TEST(RutProfiles, CrossWhatLiesInTheirStrip) {
  const std::vector<RoadDamageRecord> pothole{damage_at(1, 2, Distress::pothole)};
  // The pothole reaches from 1.8 to 2.2 m along the lane; a profile 0.15 m to both sides.
  EXPECT_TRUE(cli::crosses_damage(profile_at(2, 0), pothole));
  EXPECT_TRUE(cli::crosses_damage(profile_at(1.7, 0), pothole));
  EXPECT_FALSE(cli::crosses_damage(profile_at(1.6, 0), pothole));
  EXPECT_TRUE(cli::crosses_damage(profile_at(2.3, 0), pothole));
  EXPECT_FALSE(cli::crosses_damage(profile_at(2.4, 0), pothole));
  // Beside the lane, 3 m wide; and ruts, which are what is measured.
  EXPECT_FALSE(cli::crosses_damage(profile_at(2, 0), std::vector{damage_at(1.8, 2, Distress::pothole)}));
  EXPECT_FALSE(cli::crosses_damage(profile_at(2, 0), std::vector{damage_at(1, 2, Distress::rut)}));
}

TEST(RutProfiles, DamageIsNoRut) {
  const std::vector<RoadDamageRecord> pothole{damage_at(0, 2, Distress::pothole)};
  std::vector<LaneProfiles> lanes(1);
  for (const double y : {0.0, 0.5, 1.0, 1.5}) lanes[0].transverse.push_back(profile_at(y, 0.002 + 0.001 * y));
  lanes[0].transverse.push_back(profile_at(2, 0.05));
  EXPECT_EQ(cli::rut_text(lanes, pothole),
            "  ruts      4 profiles, largest 3.5 mm; noise alone makes 1.0 mm; resolvable in 0; 1 more cross other "
            "damage\n");
  lanes[0].transverse.push_back(profile_at(3, 0.009));
  EXPECT_EQ(cli::rut_text(lanes, pothole).substr(0, 35), "  ruts      5 profiles, median 3.0 ");
  lanes[0].transverse = {profile_at(2, 0.05)};
  EXPECT_EQ(cli::rut_text(lanes, pothole), "  ruts      unknown: all 1 profiles cross other damage\n");
  lanes[0].transverse.clear();
  EXPECT_EQ(cli::rut_text(lanes, pothole), "  ruts      the mapped road is too narrow\n");
}

}  // namespace
}  // namespace roadstereo
