// Positions of frames along a track.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/degrees.hpp"
#include "flight/flight_positions.hpp"

namespace roadstereo::cli {
namespace {

// 20 s at a stop, with positions that are 2 cm off to one side and the other, between two ways of 10 m at 1 m/s.
TEST(FlightPositions, StationStandsStillWithCamera) {
  constexpr double north_m = 111132.0;  // metres of a degree of latitude at 45°, to 1 mm over 20 m
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "station_track.csv";
  std::ofstream text(file);
  text << "time,lat,lon\n";
  constexpr int frames = 400;
  for (int i = 0; i <= frames; ++i) {
    const double moved_m = i < 100 ? 0.1 * i : i < 300 ? 10 + (i % 2 == 0 ? 0.02 : -0.02) : 10 + 0.1 * (i - 300);
    char line[80];
    std::snprintf(line, sizeof line, "%.1f,%.10f,9\n", 0.1 * i, 45 + moved_m / north_m);
    text << line;
  }
  text.close();
  TrackSettings settings;
  settings.file = file.string();
  FlightPositions positions(settings);
  for (int i = 0; i < frames; ++i) {
    io::FlightFrame frame;
    frame.index = i;
    frame.time_s = 0.1 * i;
    positions.add(frame, {});
  }
  positions.place({});
  std::filesystem::remove(file);
  const auto station_m = [&](int i) { return positions.frames()[static_cast<std::size_t>(i)].station_m; };
  EXPECT_EQ(station_m(0), 0);
  EXPECT_NEAR(station_m(57), 5.7, 0.01);
  EXPECT_NEAR(station_m(200), 10, 0.05);
  EXPECT_NEAR(station_m(299), 10, 0.05);
  EXPECT_NEAR(station_m(399), 19.9, 0.1);
  for (int i = 1; i < frames; ++i) EXPECT_GE(station_m(i), station_m(i - 1)) << i;
}

// Fixes at 0 and 2 s, and after a gap at 60 and 61 s.
TEST(FlightPositions, GapsOfTrackAreTold) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "gap_track.csv";
  std::ofstream(file) << "time,lat,lon\n0,45,9\n2,45.00001,9\n60,45.0003,9\n61,45.0003,9\n";
  TrackSettings settings;
  settings.file = file.string();
  const auto placed = [&](std::vector<double> times_s) {
    FlightPositions positions(settings);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      io::FlightFrame frame;
      frame.index = static_cast<std::int64_t>(i);
      frame.time_s = times_s[i];
      positions.add(frame, {});
    }
    positions.place({});
    return positions;
  };
  const std::string apart = "frames lie between fixes that are too far apart, up to 58 s (limit 5 s)";
  const FlightPositions some = placed({1, 3, 30, 60.5, 70});
  EXPECT_EQ(some.located(), 2U);
  EXPECT_EQ(some.gaps_text(), "2 of 5 " + apart);
  EXPECT_EQ(some.no_position_reason(), "");
  const FlightPositions none = placed({20, 21});
  EXPECT_EQ(none.no_position_reason(), "2 of 2 " + apart);
  const FlightPositions later = placed({70, 71});
  EXPECT_EQ(later.gaps_text(), "");
  EXPECT_NE(later.no_position_reason().find("--track-offset"), std::string::npos);
  EXPECT_EQ(placed({0.5, 1.5}).gaps_text(), "");
  std::filesystem::remove(file);
}

// A receiver whose fixes wander by metres while the camera stands at a traffic light for 30 s, as the poses tell.
TEST(FlightPositions, StationIsNotThatOfWanderingFixes) {
  constexpr double north_m = 111132.0;
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "wandering_track.csv";
  std::ofstream text(file);
  text << "time,lat,lon\n";
  const auto moved_m = [](int i) { return i < 10 ? 1.0 * i : i < 40 ? 10.0 : i - 30.0; };
  for (int i = 0; i < 50; ++i) {
    const double fix_m = moved_m(i) + (i > 10 && i < 40 ? 2 * std::sin(i) : 0);
    char line[80];
    std::snprintf(line, sizeof line, "%d,%.10f,9\n", i, 45 + fix_m / north_m);
    text << line;
  }
  text.close();
  TrackSettings settings;
  settings.file = file.string();
  const auto last_station_m = [&](bool has_poses) {
    FlightPositions positions(settings);
    for (int i = 0; i < 50; ++i) {
      io::FlightFrame frame;
      frame.index = i;
      frame.time_s = i;
      frame.height_m = 1.5;
      if (has_poses) frame.pose = {0, {1, 0, 0, 0, 0, 0, -1, 1.5, 0, 1, 0, moved_m(i)}};
      positions.add(frame, {});
    }
    positions.place({});
    return positions.frames().back().station_m;
  };
  EXPECT_NEAR(last_station_m(true), 19, 0.1);
  EXPECT_GT(last_station_m(false), 40);
  std::filesystem::remove(file);
}

// A camera that drives north and looks to the right sees a hole 3 m before it, which is no farther along the way, and 1
// m to its left, which is 1 m farther.
TEST(FlightPositions, DamageHasItsOwnStation) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "damage_track.csv";
  std::ofstream(file) << "time,lat,lon\n0,45,9\n4,45.0009,9\n";
  for (const auto [yaw_deg, right_m, forward_m, ahead_m] :
       {std::array{0.0, 1.0, 6.0, 6.0}, {90.0, -1.0, 3.0, 1.0}, {180.0, 0.0, 4.0, -4.0}}) {
    TrackSettings settings;
    settings.file = file.string();
    settings.mount_yaw_deg = yaw_deg;
    FlightPositions positions(settings);
    for (int i = 0; i < 4; ++i) {
      io::FlightFrame frame;
      frame.index = i;
      frame.time_s = i;
      positions.add(frame, {});
    }
    positions.place({});
    io::RoadDamage damage;
    damage.frame = 2;
    damage.best.metrics.emplace().road_centroid_m = {right_m, forward_m};
    positions.locate(damage);
    EXPECT_NEAR(damage.station_m, positions.frames()[2].station_m + ahead_m, 1e-9) << yaw_deg;
  }
  std::filesystem::remove(file);
}

// 20 m to the north at 1 m/s and back on the same way. A hole 8 m from the start is first seen 5 m ahead, and best on
// the way back, 2 m ahead: its place is that of the best frame, its station that of the way there.
TEST(FlightPositions, StationIsThatOfFirstPass) {
  constexpr double north_m = 111132.0;
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "there_and_back_track.csv";
  std::ofstream text(file);
  text << "time,lat,lon\n";
  for (int i = 0; i <= 40; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%d,%.10f,9\n", i, 45 + (i <= 20 ? i : 40 - i) / north_m);
    text << line;
  }
  text.close();
  TrackSettings settings;
  settings.file = file.string();
  FlightPositions positions(settings);
  for (int i = 0; i <= 40; ++i) {
    io::FlightFrame frame;
    frame.index = i;
    frame.time_s = i;
    positions.add(frame, {});
  }
  positions.place({});
  std::filesystem::remove(file);
  io::RoadDamage damage;
  damage.first_frame = 3;
  damage.last_frame = 31;
  damage.frame = 30;
  damage.best.metrics.emplace().road_centroid_m = {0.5, 2};
  positions.locate(damage);
  EXPECT_NEAR(damage.station_m, 8, 0.02);
  EXPECT_DOUBLE_EQ(damage.ahead_m, 2);
  ASSERT_TRUE(damage.position);
  EXPECT_NEAR((damage.position->lat_deg - 45) * north_m, 8, 0.02);
  damage.first_frame = 25;
  positions.locate(damage);
  EXPECT_NEAR(damage.station_m, 32, 0.02) << "not seen before";
}

// A drone that flies north at 1 m/s and looks 30° to the right of that, over a road that rises to the north by 10 %.
// Its receiver is 3 m off and has no course. Frame 7 has no pose.
TEST(FlightPositions, TrajectoryPlacesFrames) {
  constexpr double north_m = 111132.0, east_m = 78847.0;  // metres of a degree at 45°
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "trajectory_track.csv";
  std::ofstream text(file);
  text << "time,lat,lon,alt\n";
  for (int i = 0; i <= 20; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%d,%.10f,%.10f,100\n", i, 45 + i / north_m, 9 + (i % 2 == 0 ? 3 : -3) / east_m);
    text << line;
  }
  text.close();
  TrackSettings settings;
  settings.file = file.string();
  FlightPositions positions(settings);
  constexpr double yaw_deg = 30, height_m = 8, foot_north_m = 0.8;  // a perpendicular onto the road leans by 10 %
  std::vector<CameraPlace> places;
  for (int i = 0; i <= 20; ++i) {
    io::FlightFrame frame;
    frame.index = i;
    frame.time_s = i;
    frame.height_m = height_m;
    if (i == 10) frame.damages.emplace_back().metrics.emplace().road_centroid_m = {0, 2};
    positions.add(frame, std::vector<std::int64_t>(frame.damages.size(), 1));
    if (i == 7) continue;
    places.push_back({i,
                      {45 + i / north_m, 9, 100, yaw_deg},
                      io::GeoPosition{45 + (i + foot_north_m) / north_m, 9, 100 - height_m, yaw_deg}});
  }
  positions.place(places);
  std::filesystem::remove(file);
  EXPECT_EQ(positions.located(), 21U);
  EXPECT_NEAR(positions.frames()[10].position->lon_deg, 9, 1e-9);
  EXPECT_NEAR(std::abs(positions.frames()[7].position->lon_deg - 9), 3 / east_m, 1e-9) << "by the track";
  EXPECT_NEAR(positions.frames()[20].station_m, 20, 0.01);
  io::RoadDamage damage;
  damage.frame = damage.first_frame = 10;
  damage.best.metrics.emplace().road_centroid_m = {0, 2};
  positions.locate(damage);
  ASSERT_TRUE(damage.position);
  const double ahead_m = 2 * std::cos(to_radians(yaw_deg)), beside_m = 2 * std::sin(to_radians(yaw_deg));
  EXPECT_NEAR((damage.position->lat_deg - 45) * north_m, 10 + foot_north_m + ahead_m, 1e-3);
  EXPECT_NEAR((damage.position->lon_deg - 9) * east_m, beside_m, 1e-3);
  EXPECT_NEAR(damage.position->alt_m, 100 - height_m, 1e-6);
  EXPECT_NEAR(damage.ahead_m, ahead_m, 1e-3);
  EXPECT_NEAR(damage.station_m, 10 + foot_north_m + ahead_m, 0.01);
}

}  // namespace
}  // namespace roadstereo::cli
