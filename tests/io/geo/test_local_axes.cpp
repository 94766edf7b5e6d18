// Axes of the Earth at a track: UTM and its grid north against each other.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/degrees.hpp"
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

// Cameras that look down, their upper border to the north, east, south and west, at the second fix.
TEST(LocalAxes, HeadingIsThatOfUpperImageBorder) {
  const LocalAxes axes(track_at(48, 11.5));
  const auto& [x, y, z] = axes.fixes()[1].position_m;
  for (const auto& [right_east, right_north, heading_deg] :
       {std::array{1.0, 0.0, 0.0}, {0.0, -1.0, 90.0}, {-1.0, 0.0, 180.0}, {0.0, 1.0, 270.0}}) {
    const GeoPosition position =
        axes.position({right_east, right_north, 0, x, right_north, -right_east, 0, y, 0, 0, -1, z});
    EXPECT_NEAR(std::remainder(position.heading_deg - heading_deg, 360.0), 0, 1e-9);
    EXPECT_NEAR(position.lat_deg, 48.001, 1e-9);
    EXPECT_NEAR(position.lon_deg, 11.5, 1e-9);
    EXPECT_NEAR(position.alt_m, 401, 1e-6);
  }
}

// The meridians of two places 10 km apart along a parallel differ by 10 km · tan φ / (radius of the parallel's normal).
TEST(LocalAxes, HeadingIsFromTrueNorthOfItsPlace) {
  const LocalAxes axes(track_at(48, 11.5));
  const GeoPosition position = axes.position({1, 0, 0, 1e4, 0, -1, 0, 0, 0, 0, -1, 0});
  const double normal_m = 6378137 / std::sqrt(1 - 0.00669438 * std::pow(std::sin(to_radians(48)), 2));
  EXPECT_NEAR(std::remainder(position.heading_deg, 360.0), to_degrees(1e4 * std::tan(to_radians(48)) / normal_m), 1e-4);
}

// A receiver that ran all the way from Hamburg: the recording is in Bavaria, in the next zone. What is odd comes before
// the recording and after it.
TEST(LocalAxes, AreThoseOfTheRecording) {
  std::vector<TrackPoint> points{{0, 53.5, 9.9, 20}};
  for (int i = 0; i < 5; ++i) points.push_back({1e5 + i, 48 + 1e-5 * i, 12.5, 400.0 + i});
  for (int i = 0; i < 9; ++i) points.push_back({2e5 + i, 47, 15, 900});
  const LocalAxes axes(Track(points), 1e5, 1e5 + 4);
  EXPECT_EQ(axes.crs(), "EPSG:32633");
  const std::array<double, 3> middle_m = axes.fixes()[3].position_m;
  for (const double value_m : middle_m) EXPECT_NEAR(value_m, 0, 1e-8);
  EXPECT_NEAR(axes.fixes()[5].position_m[2], 2, 1e-6);
  EXPECT_EQ(LocalAxes(Track(points), 0, 0).crs(), "EPSG:32632");
  // Without a fix within the time: the middle one of all 15, index 7, is the second of the last stretch.
  EXPECT_EQ(LocalAxes(Track(points), 5e4, 6e4).crs(), LocalAxes(Track(points)).crs());
  for (const double value_m : LocalAxes(Track(points), 5e4, 6e4).fixes()[7].position_m) EXPECT_NEAR(value_m, 0, 1e-8);
}

TEST(LocalAxes, PolesHaveNoUtm) {
  EXPECT_THROW(LocalAxes(track_at(87, 9)), Error);
}

}  // namespace
}  // namespace roadstereo::io
