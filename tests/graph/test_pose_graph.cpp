// Pose graphs whose solution is known in closed form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "graph/fix_curve.hpp"
#include "graph/track_alignment.hpp"
#include "odometry/link_estimator.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {
namespace {

std::array<double, 36> diagonal(double variance_m2, double variance_rad2) {
  std::array<double, 36> covariance{};
  for (std::size_t i = 0; i < 6; ++i) covariance[7 * i] = i < 3 ? variance_m2 : variance_rad2;
  return covariance;
}

FrameLink link_of(int from, int to, const RigidMotion& motion, double variance_m2, double variance_rad2 = 1e-12) {
  FrameLink link;
  link.from = from;
  link.to = to;
  link.motion = matrix_of(motion);
  link.covariance = diagonal(variance_m2, variance_rad2);
  return link;
}

/// A camera that looks straight down at a height of 2 m, its x axis to the right of the way, which has this compass
/// angle (anticlockwise from east).
RigidMotion looking_down(double x, double y, double way_rad, double z = 2) {
  RigidMotion pose;
  const double c = std::cos(way_rad), s = std::sin(way_rad);
  pose.rotation = {{{s, -c, 0}, {-c, -s, 0}, {0, 0, -1}}};
  pose.translation = {x, y, z};
  return pose;
}

/// A trajectory in the world of its first camera, and its exact links.
PoseGraphInput chain_of(const std::vector<RigidMotion>& truth, double variance_m2, double variance_rad2 = 1e-12) {
  PoseGraphInput input;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    FramePose pose;
    pose.frame = static_cast<int>(i);
    pose.camera_to_world = matrix_of(inverse(truth[0]) * truth[i]);
    input.trajectory.frames.push_back(pose);
    if (i == 0) continue;
    const RigidMotion motion = inverse(truth[i]) * truth[i - 1];
    input.links.push_back(link_of(static_cast<int>(i) - 1, static_cast<int>(i), motion, variance_m2, variance_rad2));
  }
  return input;
}

/// Corners of a square of 1 m, without turns: motions of points are those of the camera, reversed.
RigidMotion step(double x, double y) {
  RigidMotion motion;
  motion.translation = {-x, -y, 0};
  return motion;
}

PoseGraphInput square(const std::array<double, 3>& variances) {
  PoseGraphInput input;
  const std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (int i = 0; i < 4; ++i) {
    FramePose pose;
    pose.frame = i;
    const auto at = static_cast<std::size_t>(i);
    pose.camera_to_world[3] = corners[at][0];
    pose.camera_to_world[7] = corners[at][1];
    input.trajectory.frames.push_back(pose);
    if (i == 0) continue;
    input.links.push_back(link_of(
        i - 1, i, step(corners[at][0] - corners[at - 1][0], corners[at][1] - corners[at - 1][1]), variances[at - 1]));
  }
  return input;
}

LoopLink loop_of(const FrameLink& link) {
  return {link, {0, 0, 2}, 0.01};
}

TEST(PoseGraph, DistributesMisclosureByVariance) {
  PoseGraphInput input = square({4e-4, 1e-4, 3e-4});
  // From corner 0 to corner 3 the loop says (0.003, 1) where the chain has (0, 1): little, for robust losses bend it.
  constexpr double misclosure = 0.003, loop_variance = 2e-4, chain_variance = 8e-4;
  input.loops = {loop_of(link_of(0, 3, step(misclosure, 1), loop_variance))};
  const PoseGraphResult result = optimise_poses(input);
  const double per_variance = misclosure / (chain_variance + loop_variance);
  const std::array<double, 4> x{0, 1 + 4e-4 * per_variance, 1 + 5e-4 * per_variance, 8e-4 * per_variance};
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(result.trajectory.frames[i].camera_to_world[3], x[i], 2e-6) << i;
  }
  EXPECT_EQ(result.loops_used(), 1U);
  EXPECT_NEAR(result.misclosure().before_m, misclosure, 1e-9);
  EXPECT_NEAR(result.misclosure().before_px, 0.3, 1e-7);
  EXPECT_NEAR(result.misclosure().after_m, misclosure * loop_variance / (chain_variance + loop_variance), 2e-6);
  // Chain and loop in parallel.
  EXPECT_NEAR(result.trajectory.frames[3].covariance[0], chain_variance * loop_variance / 1e-3, 1e-7);
  EXPECT_EQ(result.trajectory.frames[0].covariance[0], 0);
}

TEST(PoseGraph, WithoutLoopsIsTheChain) {
  std::vector<RigidMotion> truth;
  for (int i = 0; i < 6; ++i) truth.push_back(looking_down(0.3 * i, 0.1 * i * i, 0.2 * i));
  const PoseGraphInput input = chain_of(truth, 1e-6, 4e-6);
  const PoseGraphResult result = optimise_poses(input);
  // Errors of the rotations act over the way that follows: σ² = n σ_t² + σ_r² Σ l², in camera axes summed over them.
  double squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t k = 0; k < 12; ++k) {
      EXPECT_NEAR(result.trajectory.frames[i].camera_to_world[k], input.trajectory.frames[i].camera_to_world[k], 1e-9);
    }
    const Vector<3> way = (inverse(truth.back()) * truth[i]).translation;
    if (i > 0) squares += dot(way, way);
  }
  const auto& covariance = result.trajectory.frames.back().covariance;
  EXPECT_NEAR(covariance[0] + covariance[7] + covariance[14], 3 * 5 * 1e-6 + 2 * 4e-6 * squares, 1e-9);
  EXPECT_NEAR(covariance[21], 5 * 4e-6, 1e-10);
}

TEST(PoseGraph, FalseLoopIsWithoutEffect) {
  PoseGraphInput input = square({4e-4, 1e-4, 3e-4});
  input.loops = {loop_of(link_of(0, 3, step(0.9, 1), 2e-4))};  // 0.9 m off, 28 standard errors
  const PoseGraphResult result = optimise_poses(input);
  EXPECT_EQ(result.loops_used(), 0U);
  EXPECT_NEAR(result.trajectory.frames[3].camera_to_world[3], 0, 1e-12);
  EXPECT_EQ(result.misclosure().before_m, 0);
}

TEST(PoseGraph, TrueLoopsOutvoteFalseOne) {
  PoseGraphInput input = square({4e-4, 4e-4, 4e-4});
  constexpr double drift = 0.02, wrong = -0.09, variance = 1e-8;  // both agree with the chain: σ = 35 mm
  for (int i = 0; i < 3; ++i) input.loops.push_back(loop_of(link_of(0, 3, step(drift, 1), variance)));
  input.loops.push_back(loop_of(link_of(0, 3, step(wrong, 1), variance)));
  const PoseGraphResult result = optimise_poses(input);
  EXPECT_EQ(result.loops_used(), 3U);
  EXPECT_FALSE(result.loops.back().used);
  EXPECT_NEAR(result.trajectory.frames[3].camera_to_world[3], drift, 1e-4);
}

/// Nobody knows a motion exactly, but whoever joins recordings by hand may give no error.
TEST(PoseGraph, LoopWithoutErrorIsUsed) {
  PoseGraphInput input = square({4e-4, 1e-4, 3e-4});
  input.loops = {loop_of(link_of(0, 3, step(0.003, 1), 0, 0))};
  const PoseGraphResult result = optimise_poses(input);
  EXPECT_NEAR(result.trajectory.frames[3].camera_to_world[3], 0.003, 1e-6);
  EXPECT_EQ(result.loops_used(), 1U);
}

TEST(PoseGraph, LinksOfUnknownFramesAreErrors) {
  PoseGraphInput input = square({1e-4, 1e-4, 1e-4});
  input.links.back().to = 7;
  EXPECT_THROW(optimise_poses(input), Error);
  PoseGraphOptions options;
  options.lever_arm_sd_m = 0;
  EXPECT_THROW(options.validate(), Error);
}

/// A survey of 60 s at 10 Hz round a bent ellipse, 40 m by 20 m, at a changing speed, and what a receiver records of
/// it.
struct Survey {
  static constexpr int frames = 600;
  std::array<double, 3> lever_arm_m{0.4, -0.3, 0};
  double clock_s = 0;  ///< of the receiver, ahead of the camera's
  double noise_m = 0;
  double pause_s = 0;  ///< after 30 s, without frames and fixes

  double time_s(double flown_s) const { return flown_s + (flown_s < 30 ? 0 : pause_s); }
  static RigidMotion at(double time_s) {
    const double phase = 2 * std::numbers::pi * (time_s / 60 + 0.03 * std::sin(2 * std::numbers::pi * time_s / 30));
    const double x = 20 * std::cos(phase) + 4 * std::sin(2 * phase), y = 10 * std::sin(phase);
    const double way_x = -20 * std::sin(phase) + 8 * std::cos(2 * phase), way_y = 10 * std::cos(phase);
    return looking_down(x, y, std::atan2(way_y, way_x), 2 + 0.2 * std::sin(3 * phase));
  }

  PoseGraphInput input() const {
    std::vector<RigidMotion> truth;
    for (int i = 0; i < frames; ++i) truth.push_back(at(0.1 * i));
    PoseGraphInput result = chain_of(truth, 1e-6, 1e-8);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, noise_m);
    for (int i = 0; i < frames; ++i) {
      result.times_s.push_back(time_s(0.1 * i));
      result.road_up.push_back(std::array<double, 3>{0, 0, -1});
    }
    for (int i = -60; i < frames / 2 + 60; ++i) {
      const Vector<3> antenna = at(0.2 * i)(lever_arm_m);
      PositionFix fix{time_s(0.2 * i) + clock_s, antenna, 0.02, 0.04};
      for (double& value : fix.position_m) value += noise_m > 0 ? noise(random) : 0;
      result.fixes.push_back(fix);
    }
    return result;
  }
};

TEST(PoseGraphTrack, LeverArmAndTimeOffsetAreFound) {
  Survey survey;
  survey.clock_s = 10.3;
  survey.noise_m = 0.02;
  const PoseGraphResult result = optimise_poses(survey.input());
  ASSERT_TRUE(result.track) << result.track_unused;
  const TrackFit& fit = *result.track;
  EXPECT_EQ(fit.frames, 600U);
  EXPECT_NEAR(fit.time_offset_s.value, 10.3, 4 * fit.time_offset_s.std_error);
  EXPECT_LT(fit.time_offset_s.std_error, 0.05);
  for (const std::size_t axis : {0U, 1U}) {
    EXPECT_NEAR(fit.lever_arm_m[axis].value, survey.lever_arm_m[axis], 4 * fit.lever_arm_m[axis].std_error) << axis;
    EXPECT_LT(fit.lever_arm_m[axis].std_error, 0.05);
  }
  // Along the vertical nothing tells the antenna from the height of the flight.
  EXPECT_GT(fit.lever_arm_m[2].std_error, 0.9);
  for (int i = 0; i < Survey::frames; i += 50) {
    const auto& pose = result.trajectory.frames[static_cast<std::size_t>(i)].camera_to_world;
    const RigidMotion truth = Survey::at(0.1 * i);
    EXPECT_NEAR(pose[3], truth.translation[0], 0.06) << i;
    EXPECT_NEAR(pose[7], truth.translation[1], 0.06) << i;
    EXPECT_NEAR(pose[0], truth.rotation[0][0], 0.01) << i;
  }
}

// An hour between two sessions is no time over which the noise of fixes averages out.
TEST(PoseGraphTrack, PauseMakesFixesNoBetter) {
  Survey survey;
  survey.noise_m = 0.02;
  const PoseGraphResult whole = optimise_poses(survey.input());
  survey.pause_s = 3600;
  const PoseGraphResult paused = optimise_poses(survey.input());
  ASSERT_TRUE(whole.track && paused.track);
  for (const std::size_t i : {0U, 299U, 599U}) {
    const double sd = std::sqrt(whole.trajectory.frames[i].covariance[0]);
    EXPECT_NEAR(std::sqrt(paused.trajectory.frames[i].covariance[0]), sd, 0.2 * sd) << i;
  }
}

TEST(PoseGraphTrack, AltitudesMayBeMissing) {
  PoseGraphInput input = Survey{}.input();
  for (PositionFix& fix : input.fixes) fix.position_m[2] = NAN;
  const PoseGraphResult result = optimise_poses(input);
  ASSERT_TRUE(result.track) << result.track_unused;
  const auto& pose = result.trajectory.frames[300].camera_to_world;
  EXPECT_NEAR(pose[3], Survey::at(30).translation[0], 0.06);
  EXPECT_NEAR(pose[10], -1, 1e-3);  // looks down, as the road says
  EXPECT_GT(result.trajectory.frames[300].covariance[14], 1);
}

// One fix without an altitude among others is between its neighbours, and bends nothing.
TEST(PoseGraphTrack, OneMissingAltitudeIsBetweenItsNeighbours) {
  constexpr double level_m = 30;
  std::vector<PositionFix> fixes;
  for (int i = 0; i < 8; ++i) fixes.push_back({1.0 * i, {2.0 * i, 0, i == 4 ? NAN : level_m}, 0.02, 0.04});
  const FixCurve curve(fixes, 5);
  for (double time_s = 0; time_s <= 7; time_s += 0.1) {
    EXPECT_NEAR(curve.at(*curve.segment(time_s), time_s).z(), level_m, 1e-9) << time_s;
  }
}

// Steps longer than a gap between fixes are pauses, but no recording without time.
TEST(PoseGraphTrack, SlowRecordingLastsAsLongAsItsGaps) {
  EXPECT_DOUBLE_EQ(recorded_s(std::array<double, 4>{0, 4, NAN, 8}, 5), 8);
  EXPECT_DOUBLE_EQ(recorded_s(std::array<double, 3>{0, 6, 12}, 5), 10);
}

TEST(PoseGraphTrack, ClockStaysWithinItsLimit) {
  Survey survey;
  survey.clock_s = 0.8;
  PoseGraphOptions options;
  for (const double limit_s : {0.0, 0.3}) {
    options.max_time_offset_s = limit_s;
    const PoseGraphResult result = optimise_poses(survey.input(), options);
    ASSERT_TRUE(result.track) << limit_s << " s: " << result.track_unused;
    EXPECT_LE(std::abs(result.track->time_offset_s.value), limit_s + 1e-5);
  }
}

// A receiver that loses its corrections: 4 m off for half of the time, and it knows that they are missing.
TEST(PoseGraphTrack, FixesCountAsWellAsTheyAreKnown) {
  for (const bool good_first : {true, false}) {
    PoseGraphInput input = Survey{}.input();
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      PositionFix& fix = input.fixes[i];
      if ((i % 100 < 50) == good_first) continue;
      fix.position_m[0] += 4;
      fix.horizontal_sd_m = 5;
      fix.vertical_sd_m = 10;
    }
    const PoseGraphResult result = optimise_poses(input);
    ASSERT_TRUE(result.track) << result.track_unused;
    for (int i = 0; i < Survey::frames; i += 50) {
      const FramePose& pose = result.trajectory.frames[static_cast<std::size_t>(i)];
      EXPECT_NEAR(pose.camera_to_world[3], Survey::at(0.1 * i).translation[0], 0.1) << good_first << i;
      EXPECT_NEAR(pose.camera_to_world[7], Survey::at(0.1 * i).translation[1], 0.1) << good_first << i;
      EXPECT_GT(pose.covariance[0], 1e-5) << good_first << i;  // the corrections are known to 0.02 m
    }
  }
}

// One of the fixes says that it is good, and is: the others, which are 4 m off, outvote it no longer.
TEST(PoseGraphTrack, OneGoodFixIsBelieved) {
  PoseGraphInput input = Survey{}.input();
  constexpr std::size_t good = 200;  // at 28 s
  for (std::size_t i = 0; i < input.fixes.size(); ++i) {
    if (i == good) continue;
    input.fixes[i].position_m[0] += 4;
    input.fixes[i].horizontal_sd_m = 5;
    input.fixes[i].vertical_sd_m = 10;
  }
  const PoseGraphResult result = optimise_poses(input);
  ASSERT_TRUE(result.track) << result.track_unused;
  const FramePose& pose = result.trajectory.frames[280];
  // The antenna is 0.5 m from the camera.
  EXPECT_NEAR(pose.camera_to_world[3], Survey::at(28).translation[0], 0.6);
  EXPECT_NEAR(pose.camera_to_world[7], Survey::at(28).translation[1], 0.6);
}

// The first fix of a receiver that has just been switched on: it knows that it may be far off.
TEST(PoseGraphTrack, FirstFixIsOneOfMany) {
  Survey survey;
  for (const bool mirrored : {false, true}) {
    PoseGraphInput input = survey.input();
    std::vector<PositionFix> fixes;  // from the first frame on, one every 4 s
    for (std::size_t i = 60; i < input.fixes.size(); i += 20) fixes.push_back(input.fixes[i]);
    input.fixes = fixes;
    input.fixes.front().horizontal_sd_m = 120;
    input.fixes.front().vertical_sd_m = 240;
    if (mirrored) {
      for (PositionFix& fix : input.fixes) fix.position_m[0] = -fix.position_m[0];
    }
    const PoseGraphResult result = optimise_poses(input);
    EXPECT_EQ(result.track_contradicts, mirrored) << result.track_unused;
    if (mirrored) continue;
    ASSERT_TRUE(result.track) << result.track_unused;
    EXPECT_NEAR(result.track->time_offset_s.value, 0, 0.05);
    EXPECT_NEAR(result.trajectory.frames[300].camera_to_world[3], Survey::at(30).translation[0], 0.1);
  }
}

// Where the origin is does not matter to how the poses fit: a way that climbs 5 % towards a place 75 km away.
TEST(PoseGraphTrack, PlaceFarFromOriginIsSolvedAsWell) {
  constexpr int frames = 400;
  const double grade_rad = std::atan(0.05);
  RigidMotion tilt;
  tilt.rotation = {
      {{std::cos(grade_rad), 0, -std::sin(grade_rad)}, {0, 1, 0}, {std::sin(grade_rad), 0, std::cos(grade_rad)}}};
  std::vector<RigidMotion> truth;
  double x = 0, y = 0;
  for (int i = 0; i < frames; ++i) {
    const double way_rad = 0.4 * std::sin(2 * std::numbers::pi * i / 400) + 0.3 * std::sin(i / 57.0);
    truth.push_back(orthonormal(tilt * looking_down(x, y, way_rad)));
    x += std::cos(way_rad);
    y += std::sin(way_rad);
  }
  const Vector<3> shift{7.5e4, -2e4, -400};
  PoseGraphInput input = chain_of(truth, 1e-7, 1e-8);
  for (int i = 0; i < frames; ++i) {
    input.times_s.push_back(0.1 * i);
    input.road_up.push_back(std::array<double, 3>{0, 0, -1});
    if (i % 2 != 0) continue;
    PositionFix fix{0.1 * i, truth[static_cast<std::size_t>(i)].translation, 0.02, 0.04};
    for (std::size_t axis = 0; axis < 3; ++axis) fix.position_m[axis] += shift[axis];
    input.fixes.push_back(fix);
  }
  const PoseGraphResult result = optimise_poses(input);
  ASSERT_TRUE(result.track) << result.track_unused;
  for (std::size_t i = 0; i < truth.size(); i += 21) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(result.trajectory.frames[i].camera_to_world[4 * axis + 3], truth[i].translation[axis] + shift[axis],
                  0.06)
          << i << ' ' << axis;
    }
  }
}

TEST(PoseGraphTrack, MirroredTrackIsRefused) {
  PoseGraphInput input = Survey{}.input();
  for (PositionFix& fix : input.fixes) fix.position_m[0] = -fix.position_m[0];
  const PoseGraphResult result = optimise_poses(input);
  EXPECT_FALSE(result.track);
  EXPECT_TRUE(result.track_contradicts);
  EXPECT_NE(result.track_unused.find("mirrored"), std::string::npos) << result.track_unused;
  EXPECT_NEAR(result.trajectory.frames[0].camera_to_world[3], 0, 1e-12);
}

// A receiver that repeats its last position, exactly or as well as it can, fits within its standard errors of 20 m.
TEST(PoseGraphTrack, TrackThatStandsStillIsRefused) {
  for (const double noise_m : {0.0, 0.5}) {
    Survey survey;
    survey.noise_m = noise_m;
    PoseGraphInput input = survey.input();
    const PoseGraphInput exact = Survey{}.input();
    for (std::size_t i = 0; i < input.fixes.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double noise = input.fixes[i].position_m[axis] - exact.fixes[i].position_m[axis];
        input.fixes[i].position_m[axis] = (axis == 0 ? 1000 : 0) + noise;
      }
      input.fixes[i].horizontal_sd_m = 20;
    }
    const PoseGraphResult result = optimise_poses(input);
    EXPECT_FALSE(result.track);
    EXPECT_TRUE(result.track_contradicts);
    EXPECT_NE(result.track_unused.find("stands still"), std::string::npos) << result.track_unused;
  }
}

TEST(PoseGraphTrack, TrackOfAnotherFlightIsRefused) {
  PoseGraphInput input = Survey{}.input();
  for (PositionFix& fix : input.fixes) fix.position_m = {3 * fix.time_s, 20 * std::sin(0.7 * fix.time_s), 2};
  const PoseGraphResult result = optimise_poses(input);
  EXPECT_FALSE(result.track);
  EXPECT_TRUE(result.track_contradicts);
  EXPECT_NE(result.track_unused.find("do not fit"), std::string::npos) << result.track_unused;
}

TEST(PoseGraphTrack, PiecesWithoutLinkGetOneWorld) {
  PoseGraphInput input = Survey{}.input();
  constexpr int cut = 250;
  const RigidMotion elsewhere = inverse(Survey::at(0)) * Survey::at(0.1 * cut);
  for (FramePose& pose : input.trajectory.frames) {
    if (pose.frame < cut) continue;
    pose.piece = 1;
    RigidMotion motion;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) motion.rotation[i][j] = pose.camera_to_world[4 * i + j];
      motion.translation[i] = pose.camera_to_world[4 * i + 3];
    }
    pose.camera_to_world = matrix_of(inverse(elsewhere) * motion);
  }
  input.links.erase(input.links.begin() + cut - 1);
  const PoseGraphResult result = optimise_poses(input);
  ASSERT_TRUE(result.track) << result.track_unused;
  for (const FramePose& pose : result.trajectory.frames) {
    EXPECT_EQ(pose.piece, 0);
    EXPECT_NEAR(pose.camera_to_world[3], Survey::at(0.1 * pose.frame).translation[0], 0.1) << pose.frame;
    EXPECT_NEAR(pose.camera_to_world[7], Survey::at(0.1 * pose.frame).translation[1], 0.1) << pose.frame;
  }
}

}  // namespace
}  // namespace roadstereo
