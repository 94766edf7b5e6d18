#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "live/path_finder.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {
namespace {

constexpr double period_s = 0.1;

/// Matched frames of a flight straight ahead by 0.05 m a frame, and their calibration.
struct MatchedFlight {
  std::vector<FollowedFrame> frames;
  StereoCalibration calibration;

  explicit MatchedFlight(int count) {
    synth::Scene scene = synth::named_scene("uav");
    scene.rig.width /= 2;
    scene.rig.height /= 2;
    scene.rig.focal_px /= 2;
    scene.supersampling = 1;
    calibration = scene.rig.calibration();
    Pipeline pipeline(preset("fast"), calibration);
    for (int i = 0; i < count; ++i) {
      synth::Scene at = scene;
      at.rig.y_m += 0.05 * i;
      const synth::SyntheticPair pair = synth::render(at);
      FrameResult result;
      pipeline.process(pair.left.view(), pair.right.view(), result);
      frames.push_back({std::move(result.grey), std::move(result.disparity), std::move(result.sigma),
                        result.geometry.plane, Clock::time_point{} + clock_span(period_s * i)});
    }
  }
};

/// Adds a frame as soon as it is not skipped.
SharedPath add_when_due(PathFinder& finder, const FollowedFrame& frame) {
  using namespace std::chrono_literals;
  for (int attempt = 0; attempt < 10000; ++attempt) {
    if (SharedPath path = finder.add(frame)) return path;
    std::this_thread::sleep_for(1ms);
  }
  return nullptr;
}

TEST(PathFinder, FollowsFlightWithinItsShareOfTime) {
  const MatchedFlight flight(8);
  PathFinder finder(flight.calibration);
  SharedPath path;
  for (const FollowedFrame& frame : flight.frames) {
    path = add_when_due(finder, frame);
    ASSERT_TRUE(path);
  }
  EXPECT_EQ(path->pieces, 1);
  EXPECT_EQ(path->points_m.size(), 8U);
  // Along y, from the foot of the first camera; a pixel covers 12 mm of the road.
  EXPECT_NEAR(path->points_m.back()[0] - path->points_m.front()[0], 0, 0.012);
  EXPECT_NEAR(path->points_m.back()[1] - path->points_m.front()[1], 0.35, 0.012);
  EXPECT_NEAR(path->length_m, 0.35, 0.02);
  EXPECT_NEAR(path->heading_rad, 0, 0.02);
  EXPECT_GT(path->odometry_ms, 0);
  EXPECT_LE(path->share, PathFinder::max_share + 1e-9);
}

TEST(PathFinder, SkipsWhatComesTooSoon) {
  const MatchedFlight flight(2);
  PathFinder finder(flight.calibration);
  ASSERT_TRUE(finder.add(flight.frames[0]));
  EXPECT_FALSE(finder.add(flight.frames[1]));  // the first took more time than has passed since
  EXPECT_TRUE(add_when_due(finder, flight.frames[1]));
}

TEST(PathFinder, BeginsAnewAfterBreak) {
  MatchedFlight flight(3);
  flight.calibration.width = flight.calibration.height = 0;  // for any size
  PathFinder finder(flight.calibration);
  add_when_due(finder, flight.frames[0]);
  add_when_due(finder, flight.frames[1]);
  FollowedFrame unlike = flight.frames[2];  // nothing of it was seen before
  unlike.grey.assign(unlike.grey.width(), unlike.grey.height(), 100);
  const SharedPath path = add_when_due(finder, unlike);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->pieces, 2);
  EXPECT_EQ(path->points_m.size(), 1U);
  FollowedFrame smaller = flight.frames[2];  // of a camera that was reconnected with another size
  smaller.grey.assign(160, 90, 100);
  smaller.disparity.assign(160, 90, 10);
  smaller.sigma.assign(160, 90, 0.1F);
  smaller.arrival += clock_span(period_s);
  EXPECT_EQ(add_when_due(finder, smaller)->pieces, 3);
}

}  // namespace
}  // namespace roadstereo::cli
