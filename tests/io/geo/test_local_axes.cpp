// Axes of the Earth at a track: UTM and its grid north against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/local_axes.hpp"

namespace roadstereo::io {
namespace {

Track track_at(double lat_deg, double lon_deg) {
  TrackPoint first{0, lat_deg, lon_deg, 400}, second{1, lat_deg + 1e-3, lon_deg, 401};
  second.horizontal_sd_m = 0.02;
  return Track({first, second});
}

TEST(LocalAxes, FixesAreMetresAtTheFirstOne) {
  const LocalAxes axes(track_at(48, 11.5));
  ASSERT_EQ(axes.fixes().size(), 2U);
  EXPECT_NEAR(axes.fixes()[0].position_m[1], 0, 1e-9);
  // 0.001° along the meridian at 48°: a(1 − e²)/(1 − e² sin² φ)^1.5 · π/180 = 111.1903 km per degree, at 400 m height
  // 1 + 400/6.37e6 times as much.
  EXPECT_NEAR(axes.fixes()[1].position_m[1], 111.1903 * (1 + 400 / 6.37e6), 2e-3);
  EXPECT_NEAR(axes.fixes()[1].position_m[2], 1 - 111.19 * 111.19 / (2 * 6.37e6), 1e-4);
  EXPECT_EQ(axes.fixes()[0].horizontal_sd_m, PositionFix().horizontal_sd_m);
  EXPECT_EQ(axes.fixes()[1].horizontal_sd_m, 0.02);
}

TEST(LocalAxes, GridNorthIsThatOfPositions) {
  for (const double lon_deg : {6.5, 9.0, 11.5}) {
    for (const double lat_deg : {48.0, -33.0}) {
      const LocalAxes axes(track_at(lat_deg, lon_deg));
      EXPECT_EQ(axes.crs(), lat_deg > 0 ? "EPSG:32632" : "EPSG:32732");
      std::array<double, 12> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
      const std::array<double, 12> here = axes.to_utm(pose);
      pose[7] = 100;  // north
      const std::array<double, 12> there = axes.to_utm(pose);
      const double dx = there[3] - here[3], dy = there[7] - here[7], length = std::hypot(dx, dy);
      EXPECT_NEAR(dx / length, here[1], 1e-5) << lat_deg << ' ' << lon_deg;
      EXPECT_NEAR(dy / length, here[5], 1e-5) << lat_deg << ' ' << lon_deg;
      EXPECT_NEAR(length, 100, 0.1);
      EXPECT_NEAR(here[11], 400, 1e-6);
      if (lon_deg == 9.0) {
        EXPECT_NEAR(length, 99.96, 0.01);  // the scale of the central meridian
      }
    }
  }
}

TEST(LocalAxes, PolesHaveNoUtm) {
  EXPECT_THROW(LocalAxes(track_at(87, 9)), Error);
}

}  // namespace
}  // namespace roadstereo::io
