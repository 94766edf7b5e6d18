// Successive frames over one road.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "roadstereo/error.hpp"
#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

TEST(FlightPath, FramesMoveAlongRoad) {
  const Scene scene = small_scene("uav");
  const Scene first = next_frame(scene, 0, 0.1);
  EXPECT_EQ(first.rig.y_m, scene.rig.y_m);
  EXPECT_EQ(first.rig.roll_deg, scene.rig.roll_deg);
  EXPECT_EQ(first.rig.camera_height_m, scene.rig.camera_height_m);
  for (int frame = 1; frame < 50; ++frame) {
    const Scene next = next_frame(scene, frame, 0.1);
    EXPECT_NEAR(next.rig.y_m, 0.1 * frame, 1e-12);
    EXPECT_LT(std::abs(next.rig.roll_deg), 1);
    EXPECT_LT(std::abs(next.rig.roll_deg - next_frame(scene, frame - 1, 0.1).rig.roll_deg), 0.1);
    EXPECT_NO_THROW(next.validate());
  }
  // The road stays: what the first frame measured of it, the last one does too.
  const SyntheticPair a = render(scene);
  const SyntheticPair b = render(next_frame(scene, 3, 0.1));
  EXPECT_EQ(a.damages[0].volume_m3, b.damages[0].volume_m3);
  EXPECT_NEAR(warp_rms(b, 0), 0, 4);
}

TEST(FlightPath, RollsPitchesAndClimbs) {
  const Scene scene = small_scene("uav");
  FlightPath path;
  path.roll_deg = 6;
  path.pitch_deg = 4;
  path.climb_m = 0.5;
  path.roll_period = path.pitch_period = path.climb_period = 40;
  path.step_m = 0.2;
  const Rig start = flight_frame(scene, path, 0).rig;
  EXPECT_EQ(start.roll_deg, scene.rig.roll_deg);
  EXPECT_EQ(start.pitch_deg, scene.rig.pitch_deg);
  EXPECT_EQ(start.camera_height_m, scene.rig.camera_height_m);
  EXPECT_EQ(start.y_m, scene.rig.y_m);
  // A quarter of the period: the sines are at their highest, the height is half-way up.
  const Rig quarter = flight_frame(scene, path, 10).rig;
  EXPECT_NEAR(quarter.roll_deg, scene.rig.roll_deg + 6, 1e-9);
  EXPECT_NEAR(quarter.pitch_deg, scene.rig.pitch_deg + 4, 1e-9);
  EXPECT_NEAR(quarter.camera_height_m, scene.rig.camera_height_m + 0.25, 1e-9);
  EXPECT_NEAR(quarter.y_m, scene.rig.y_m + 2, 1e-9);
  const Rig half = flight_frame(scene, path, 20).rig;
  EXPECT_NEAR(half.roll_deg, scene.rig.roll_deg, 1e-9);
  EXPECT_NEAR(half.camera_height_m, scene.rig.camera_height_m + 0.5, 1e-9);
}

TEST(FlightPath, ShutterRollsBetweenRows) {
  FlightPath path;
  path.roll_deg = path.pitch_deg = path.climb_m = 0;
  path.step_m = 0.2;
  path.shutter_frames = 0.5;
  const Scene scene = flight_frame(small_scene("uav"), path, 3);
  EXPECT_NEAR(scene.shutter.y_m, 0.1, 1e-12);
  EXPECT_EQ(scene.shutter.roll_deg, 0);
  const SyntheticPair rolling = render(scene);
  // The first row is that of a rig half of it behind, the last one that of a rig half of it ahead.
  const int last = scene.rig.height - 1;
  for (const auto& [row, shift_m] : {std::pair(0, -0.05), std::pair(last, 0.05)}) {
    Scene still = scene;
    still.shutter = {};
    still.rig.y_m += shift_m;
    const SyntheticPair global = render(still);
    for (int u = 0; u < scene.rig.width; ++u) {
      const auto at = static_cast<std::size_t>(row * scene.rig.width + u);
      ASSERT_NEAR(rolling.left.bytes[at], global.left.bytes[at], 1) << row << ' ' << u;
      ASSERT_NEAR(rolling.right.bytes[at], global.right.bytes[at], 1) << row << ' ' << u;
    }
  }
  path.shutter_frames = 1.5;
  EXPECT_THROW(path.validate(), Error);
}

TEST(FlightPath, LoopCloses) {
  const Scene scene = small_scene("uav");
  FlightPath path;
  path.roll_deg = path.pitch_deg = path.climb_m = 0;
  path.step_m = 0.1;
  path.loop_period = 40;
  const double radius = 40 * 0.1 / (2 * std::numbers::pi);
  const Rig quarter = flight_frame(scene, path, 10).rig;
  EXPECT_NEAR(quarter.x_m, scene.rig.x_m + radius, 1e-9);
  EXPECT_NEAR(quarter.y_m, scene.rig.y_m + radius, 1e-9);
  EXPECT_NEAR(quarter.yaw_deg, -90, 1e-9);
  const std::array<double, 12> pose = quarter.camera_to_road();
  EXPECT_GT(pose[2], 0.4);  // looks along X
  EXPECT_NEAR(pose[6], 0, 1e-12);
  const Rig again = flight_frame(scene, path, 40).rig;
  EXPECT_NEAR(again.x_m, scene.rig.x_m, 1e-9);
  EXPECT_NEAR(again.y_m, scene.rig.y_m, 1e-9);
  EXPECT_NEAR(std::remainder(again.yaw_deg, 360), 0, 1e-9);
  path.loop_period = 1;
  EXPECT_THROW(path.validate(), Error);
}

TEST(FlightPath, TurnsAndFliesBackBeside) {
  const Scene scene = small_scene("uav");
  FlightPath path;
  path.roll_deg = path.pitch_deg = path.climb_m = 0;
  path.turn_frame = 50;  // 5 m ahead; then 30 frames on half a circle of 0.15 m
  const Rig half = flight_frame(scene, path, 65).rig;
  EXPECT_NEAR(half.x_m, scene.rig.x_m + 0.15, 1e-9);
  EXPECT_NEAR(half.y_m, scene.rig.y_m + 5.15, 1e-9);
  EXPECT_NEAR(half.yaw_deg, -90, 1e-9);
  const Rig back = flight_frame(scene, path, 100).rig;
  EXPECT_NEAR(back.x_m, scene.rig.x_m + 0.3, 1e-9);
  EXPECT_NEAR(back.y_m, scene.rig.y_m + 3, 1e-9);
  EXPECT_NEAR(std::abs(back.yaw_deg), 180, 1e-9);
  path.loop_period = 40;
  EXPECT_THROW(path.validate(), Error);
}

TEST(Rig, PoseMapsTrueDisparitiesToRoad) {
  Scene scene = small_scene("uav");
  scene.rig.roll_deg = 3;
  scene.rig.x_m = 0.4;
  for (const double yaw : {0.0, 90.0, 180.0, -30.0}) {
    scene.rig.yaw_deg = yaw;
    const SyntheticPair pair = render(scene);
    const std::array<double, 12> pose = scene.rig.camera_to_road();
    for (const auto& [u, v] : {std::pair{5, 9}, std::pair{80, 60}, std::pair{150, 80}}) {
      const std::array<double, 3> p = pair.calibration.point_m(u, v, pair.plane.disparity(u, v));
      EXPECT_NEAR(pose[8] * p[0] + pose[9] * p[1] + pose[10] * p[2] + pose[11], 0, 1e-9) << yaw;
    }
    const double angle = yaw * std::numbers::pi / 180;
    const std::array<double, 2> ahead{pose[2], pose[6]};  // the optical axis
    EXPECT_NEAR(ahead[0] * std::cos(angle) + ahead[1] * std::sin(angle), 0, 1e-9);
    EXPECT_GT(-ahead[0] * std::sin(angle) + ahead[1] * std::cos(angle), 0.1);
  }
}

TEST(FlightPath, JumpsAndReturns) {
  const Scene scene = small_scene("uav");
  FlightPath path;
  path.roll_deg = path.pitch_deg = path.climb_m = path.step_m = 0;
  path.jumps = {3, 5};
  path.jump_roll_deg = -7;
  path.jump_pitch_deg = 2;
  path.jump_climb_m = 0.4;
  path.jump_step_m = 10;
  for (const int frame : {0, 2, 3, 4, 5, 6}) {
    const Rig rig = flight_frame(scene, path, frame).rig;
    const bool away = frame == 3 || frame == 4;
    EXPECT_NEAR(rig.roll_deg, scene.rig.roll_deg + (away ? -7 : 0), 1e-9) << frame;
    EXPECT_NEAR(rig.pitch_deg, scene.rig.pitch_deg + (away ? 2 : 0), 1e-9) << frame;
    EXPECT_NEAR(rig.camera_height_m, scene.rig.camera_height_m + (away ? 0.4 : 0), 1e-9) << frame;
    EXPECT_NEAR(rig.y_m, scene.rig.y_m + (frame < 3 ? 0 : away ? 10 : 20), 1e-9) << frame;
  }
}

TEST(FlightPath, RejectsBadValuesByName) {
  const auto complaint = [](const auto& spoil, int frame = 1) {
    FlightPath path;
    spoil(path);
    return message_of([&] { flight_frame(named_scene("uav"), path, frame); });
  };
  EXPECT_NE(complaint([](FlightPath& p) { p.roll_deg = 46; }).find("roll_deg is 46"), std::string::npos);
  EXPECT_NE(complaint([](FlightPath& p) { p.climb_period = 1; }).find("climb_period is 1"), std::string::npos);
  EXPECT_NE(complaint([](FlightPath& p) { p.step_m = NAN; }).find("step_m"), std::string::npos);
  EXPECT_NE(complaint([](FlightPath& p) { p.jumps = {0}; }).find("frame 0"), std::string::npos);
  EXPECT_NE(complaint([](FlightPath& p) { p.jumps = {4, 4}; }).find("frame 4 jumps twice"), std::string::npos);
  EXPECT_NE(complaint([](FlightPath&) {}, -1).find("frame is -1"), std::string::npos);
  // Into the ground.
  EXPECT_NE(complaint([](FlightPath& p) {
              p.jumps = {1};
              p.jump_climb_m = -5;
            }).find("camera_height_m"),
            std::string::npos);
}

}  // namespace
}  // namespace roadstereo::synth
