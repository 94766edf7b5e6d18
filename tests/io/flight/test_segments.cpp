// Segments of the road of a flight.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/road_segments.hpp"

namespace roadstereo::io {
namespace {

GeoFrame frame_at(double station_m) {
  GeoFrame frame;
  frame.station_m = station_m;
  return frame;
}

RoadDamage damage_at(double station_m) {
  RoadDamage damage;
  damage.station_m = station_m;
  return damage;
}

/// Frames every 5 m; damages at 12 m and 19.9 m are of the first 20 m, one at 41 m of the third.
TEST(RoadSegments, CountByStation) {
  std::vector<GeoFrame> frames(9);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].station_m = 5.0 * static_cast<double>(i) + 2;
    frames[i].height_m = i == 3 ? 9 : 2;
    frames[i].roll_rad = 0.1 * static_cast<double>(i);
    if (frames[i].station_m > 40 || i == 0) frames[i].sigma_d_px = 0.1;  // the others show no road
  }
  std::vector<RoadDamage> damages(4);
  const std::array<double, 4> stations{12, 19.9, 41, FlightFrame::unknown};
  for (std::size_t i = 0; i < 4; ++i) {
    damages[i].id = static_cast<std::int64_t>(i) + 1;
    damages[i].station_m = stations[i];
    DamageMetrics& metrics = damages[i].best.metrics.emplace();
    metrics.max_depth_m = {i == 1 ? 0.06 : 0.03, 0.001};
    metrics.area_m2 = {0.25, 0.01};
  }
  const std::vector<RoadSegment> segments = road_segments(frames, damages);
  ASSERT_EQ(segments.size(), 3U);
  EXPECT_EQ(segments[0].damages, 2);
  EXPECT_EQ(segments[0].worst, 2);
  EXPECT_DOUBLE_EQ(segments[0].area_m2, 0.5);
  EXPECT_EQ(segments[0].frames, 4);
  EXPECT_DOUBLE_EQ(segments[0].height_m, 2);
  EXPECT_EQ(segments[1].damages, 0);
  EXPECT_EQ(segments[1].worst, 0);
  EXPECT_NEAR(segments[1].roll_rad, 0.6, 1e-12) << "upper median of 0.4 … 0.7";
  EXPECT_EQ(segments[2].damages, 1);
  EXPECT_DOUBLE_EQ(segments[2].to_m, 42);
  EXPECT_EQ(segments[0].inspected, 1);
  EXPECT_EQ(segments[1].inspected, 0);
  const std::string csv = segments_csv(segments, damages);
  EXPECT_EQ(csv.find("from_m,to_m,frames,inspected,damages"), 0U);
  EXPECT_NE(csv.find("\n20.0,40.0,4,0,,,"), std::string::npos) << "nothing is known of damage there: " << csv;
  EXPECT_TRUE(road_segments({}, damages).empty());
}

TEST(RoadSegments, LeaveOutStationsBesideRoad) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<GeoFrame> frames{frame_at(-3), frame_at(0), frame_at(30), frame_at(infinity), frame_at(NAN)};
  const std::vector<RoadDamage> damages{damage_at(-1e300), damage_at(-0.5),  damage_at(0),       damage_at(30),
                                        damage_at(30.5),   damage_at(1e300), damage_at(infinity)};
  const std::vector<RoadSegment> segments = road_segments(frames, damages);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].frames, 1);
  EXPECT_EQ(segments[0].damages, 1);
  EXPECT_EQ(segments[1].frames, 1);
  EXPECT_EQ(segments[1].damages, 1);
  EXPECT_DOUBLE_EQ(segments[1].to_m, 30);
}

TEST(RoadSegments, RejectLengthsWithoutSegments) {
  const std::vector<GeoFrame> frames{frame_at(0), frame_at(30)};
  for (const double length_m : {0.0, -20.0, 1e-300, double{NAN}}) {
    EXPECT_THROW(road_segments(frames, {}, length_m), Error) << length_m;
  }
}

}  // namespace
}  // namespace roadstereo::io
