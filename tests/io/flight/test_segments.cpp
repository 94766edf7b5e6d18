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

GeoFrame frame_at(std::int64_t index, double station_m) {
  GeoFrame frame;
  frame.index = index;
  frame.station_m = station_m;
  return frame;
}

RoadDamage damage_at(std::int64_t frame, double station_m) {
  RoadDamage damage;
  damage.frame = damage.first_frame = damage.last_frame = frame;
  damage.station_m = station_m;
  return damage;
}

/// Frames every 5 m; damages at 12 m and 19.9 m are of the first 20 m, one at 41 m of the third.
TEST(RoadSegments, CountByStation) {
  std::vector<GeoFrame> frames(9);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<std::int64_t>(i);
    frames[i].station_m = 5.0 * static_cast<double>(i) + 2;
    frames[i].height_m = i == 3 ? 9 : 2;
    frames[i].roll_rad = 0.1 * static_cast<double>(i);
    if (frames[i].station_m > 40 || i == 0) frames[i].damages = 0;  // the others show no road
  }
  std::vector<RoadDamage> damages;
  const std::array<double, 4> stations{12, 19.9, 41, FlightFrame::unknown};
  const std::array<std::int64_t, 4> measured_in{1, 2, 7, 9};
  for (std::size_t i = 0; i < 4; ++i) {
    damages.push_back(damage_at(measured_in[i], stations[i]));
    damages[i].id = static_cast<std::int64_t>(i) + 1;
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
  const std::vector<GeoFrame> frames{frame_at(0, -3), frame_at(1, 0), frame_at(2, 30), frame_at(3, infinity),
                                     frame_at(4, NAN)};
  const std::vector<RoadDamage> damages{damage_at(0, -2),  damage_at(1, 0),        damage_at(2, 30),
                                        damage_at(4, NAN), damage_at(3, infinity), damage_at(7, 5)};
  const std::vector<RoadSegment> segments = road_segments(frames, damages);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].frames, 1);
  EXPECT_EQ(segments[0].damages, 1);
  EXPECT_EQ(segments[1].frames, 1);
  EXPECT_EQ(segments[1].damages, 1);
  EXPECT_DOUBLE_EQ(segments[1].to_m, 30);
}

/// A camera that looks ahead has seen what lies beyond its last position, one that looks back what lies before its
/// first.
TEST(RoadSegments, HaveWhatCameraSeesAheadAndBehind) {
  const std::vector<GeoFrame> frames{frame_at(0, 0), frame_at(1, 38)};
  const std::vector<RoadDamage> damages{damage_at(0, -4), damage_at(0, 21), damage_at(1, 45)};
  const std::vector<RoadSegment> segments = road_segments(frames, damages);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].damages, 1);
  EXPECT_EQ(segments[1].damages, 2);
}

/// A rut that the border cuts in all frames, 5 m ahead of each: from 15 m to 55 m, 6 m² in each of three segments. If
/// it is 10 m long the last frame has seen the place again.
TEST(RoadSegments, ShareDamageThatGoesOn) {
  std::vector<GeoFrame> frames;
  for (int i = 0; i <= 6; ++i) frames.push_back(frame_at(i, 10.0 * i));
  RoadDamage rut = damage_at(3, 35);
  rut.id = 1;
  rut.first_frame = 1;
  rut.last_frame = 5;
  rut.ahead_m = 5;
  rut.best.cut_by_border = true;
  DamageMetrics& metrics = rut.best.metrics.emplace();
  metrics.area_m2 = {18, 1};
  metrics.length_m = 40;
  std::vector<RoadSegment> segments = road_segments(frames, {{rut}});
  ASSERT_EQ(segments.size(), 4U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(segments[k].damages, 1);
    EXPECT_EQ(segments[k].worst, 1);
    EXPECT_DOUBLE_EQ(segments[k].area_m2, 6);
  }
  EXPECT_EQ(segments[3].damages, 0);
  metrics.length_m = 10;
  segments = road_segments(frames, {{rut}});
  EXPECT_EQ(segments[1].damages, 1);
  EXPECT_EQ(segments[2].damages, 0);
  // On the way back, 60 m farther, it is seen best, and for the last time.
  for (int i = 7; i <= 12; ++i) frames.push_back(frame_at(i, 10.0 * i));
  rut.frame = 10;
  rut.last_frame = 11;
  rut.station_m = 20;
  segments = road_segments(frames, {{rut}});
  EXPECT_EQ(segments[0].damages, 1);
  EXPECT_EQ(segments[1].damages, 1);
  for (std::size_t k = 2; k < segments.size(); ++k) EXPECT_EQ(segments[k].damages, 0) << k;
}

TEST(RoadSegments, RejectLengthsWithoutSegments) {
  const std::vector<GeoFrame> frames{frame_at(0, 0), frame_at(1, 30)};
  for (const double length_m : {0.0, -20.0, 1e-300, double{NAN}}) {
    EXPECT_THROW(road_segments(frames, {}, length_m), Error) << length_m;
  }
}

}  // namespace
}  // namespace roadstereo::io
