// Stations that a road does not have, and lengths that no segment has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
