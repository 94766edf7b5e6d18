// What a track tells of the time between two clocks, where it is known in closed form: speeds that differ from their
// mean, over the noise of the fixes. A straight way at constant speed tells nothing.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "roadstereo/pose_graph.hpp"

namespace roadstereo {
namespace {

constexpr double frame_s = 0.1;
constexpr int frames = 200;

/// A drive along the x axis of the Earth, and its fixes once per second, from 20 s before the first frame to 20 s after
/// the last one. `way` is x at a time. The camera looks straight down.
struct Drive {
  std::function<double(double)> way;
  double noise_m = 0, clock_s = 0;
  unsigned seed = 1;

  PoseGraphInput input() const {
    PoseGraphInput input;
    for (int i = 0; i < frames; ++i) {
      FramePose pose;
      pose.frame = i;
      const double x = way(frame_s * i), last = way(frame_s * (i - 1));
      pose.camera_to_world = {1, 0, 0, x, 0, -1, 0, 0, 0, 0, -1, 2};
      input.trajectory.frames.push_back(pose);
      input.times_s.push_back(frame_s * i);
      input.road_up.push_back(std::array<double, 3>{0, 0, -1});
      if (i == 0) continue;
      FrameLink link;
      link.from = i - 1;
      link.to = i;
      link.motion = {1, 0, 0, last - x, 0, 1, 0, 0, 0, 0, 1, 0};
      for (std::size_t k = 0; k < 6; ++k) link.covariance[7 * k] = k < 3 ? 1e-9 : 1e-11;
      input.links.push_back(link);
    }
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1);
    for (int i = -20; i <= 40; ++i) {
      const double x = way(i) + noise_m * noise(random), y = noise_m * noise(random);
      input.fixes.push_back({i + clock_s, {x, y, 2}, 2.5, 5});
    }
    return input;
  }
};

double at_constant_speed(double time_s) {
  return 2.8 * time_s;
}

/// 4 m/s, in turn 1 m/s faster and slower, with a period of 8 s.
constexpr double change_m_per_s = 1, turns_per_s = 2 * 3.14159265358979323846 / 8;
double at_changing_speed(double time_s) {
  return 4 * time_s + change_m_per_s / turns_per_s * std::sin(turns_per_s * time_s);
}

TEST(TimeOffset, IsUnknownOnStraightAtConstantSpeed) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const PoseGraphResult result = optimise_poses(Drive{at_constant_speed, 1, 0, seed}.input());
    ASSERT_TRUE(result.track) << result.track_unused;
    EXPECT_FALSE(result.track->time_offset_found) << seed;
    EXPECT_EQ(result.track->time_offset_s.value, 0) << seed;
    EXPECT_NEAR(result.track->time_offset_s.std_error, 10, 0.1) << seed;  // as expected before: time_offset_sd_s
    for (const Measurement& axis : result.track->lever_arm_m) {
      EXPECT_EQ(axis.value, 0) << seed;
      EXPECT_NEAR(axis.std_error, 1, 0.05) << seed;  // likewise: lever_arm_sd_m
    }
    // 20 fixes of 1 m: the mean is 0.22 m off.
    EXPECT_NEAR(result.trajectory.frames[100].camera_to_world[3], at_constant_speed(10), 4 * 0.22) << seed;
  }
}

TEST(TimeOffset, InformationIsThatOfChangesOfSpeed) {
  PoseGraphOptions options;
  options.fix_correlation_s = 0;
  const PoseGraphResult result = optimise_poses(Drive{at_changing_speed}.input(), options);
  ASSERT_TRUE(result.track) << result.track_unused;
  EXPECT_TRUE(result.track->time_offset_found);
  EXPECT_NEAR(result.track->time_offset_s.value, 0, 1e-3);
  // The shift takes up the mean speed. Exact fixes count as those of the best receivers, 10 mm.
  double sum = 0, squares = 0;
  int count = 0;
  for (int i = 0; i <= 19; ++i) {
    const double change = change_m_per_s * std::cos(turns_per_s * i);
    sum += change;
    squares += change * change;
    ++count;
  }
  const double expected = 0.01 / std::sqrt(squares - sum * sum / count);
  EXPECT_NEAR(result.track->time_offset_s.std_error, expected, 0.02 * expected);
}

/// 4 m/s, changing by 0.3 m/s: with fixes of 0.3 m, of which 10 s count as one, that tells the offset to
/// 0.3 · √10 / (0.3 / √2 · √20) = 1 s.
double at_nearly_constant_speed(double time_s) {
  return 4 * time_s + 0.3 / turns_per_s * std::sin(turns_per_s * time_s);
}

TEST(TimeOffset, IsThatOfClocksThatRunTogetherWhereLittleIsTold) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const PoseGraphResult result = optimise_poses(Drive{at_nearly_constant_speed, 0.3, 0, seed}.input());
    ASSERT_TRUE(result.track) << result.track_unused;
    EXPECT_FALSE(result.track->time_offset_found) << seed;
    EXPECT_EQ(result.track->time_offset_s.value, 0) << seed;
    EXPECT_NEAR(result.track->time_offset_s.std_error, 1, 0.7) << seed;
    EXPECT_NEAR(result.trajectory.frames[100].camera_to_world[3], at_nearly_constant_speed(10), 4 * 0.067) << seed;
  }
}

/// A receiver that repeats one altitude, while the camera climbs by 0.5 m and sinks: on a straight at constant speed
/// that tells no time, however well the rest fits. A clock that leaves out the fixes of the climb is no better one.
TEST(TimeOffset, IsNotThatOfFixesLeftOut) {
  for (const double noise_m : {0.0, 0.015}) {
    for (unsigned seed = 1; seed <= (noise_m > 0 ? 4 : 1); ++seed) {
      PoseGraphInput input = Drive{at_constant_speed, noise_m, 0, seed}.input();
      for (std::size_t i = 0; i < input.trajectory.frames.size(); ++i) {
        const auto climb_m = [](std::size_t frame) {
          return 0.25 - 0.25 * std::cos(turns_per_s * 8 / 17 * frame_s * static_cast<double>(frame));
        };
        input.trajectory.frames[i].camera_to_world[11] += climb_m(i);
        if (i > 0) input.links[i - 1].motion[11] = climb_m(i) - climb_m(i - 1);  // the camera's z axis points down
      }
      const PoseGraphResult result = optimise_poses(input);
      ASSERT_TRUE(result.track) << result.track_unused;
      EXPECT_EQ(result.track->time_offset_s.value, 0) << noise_m << ' ' << seed;
      EXPECT_FALSE(result.track->time_offset_found) << noise_m << ' ' << seed;
      EXPECT_NEAR(result.trajectory.frames[100].camera_to_world[3], at_constant_speed(10), 0.05) << noise_m;
    }
  }
}

/// Changes that do not repeat: else several offsets fit.
double at_random_speed(double time_s) {
  return 4 * time_s + 2 * std::sin(0.5 * time_s) + 1.5 * std::sin(0.83 * time_s);
}

TEST(TimeOffset, IsFoundWhereSpeedChanges) {
  for (const double clock_s : {1.7, -2.3}) {
    const PoseGraphResult result = optimise_poses(Drive{at_random_speed, 0.05, clock_s}.input());
    ASSERT_TRUE(result.track) << result.track_unused;
    EXPECT_TRUE(result.track->time_offset_found);
    // Fixes of 10 s count as one: ten times the variance. Speeds differ by 1.13 m/s (RMS; amplitudes of 1 and 1.245)
    // from their mean: 0.05 · √10 / (1.13 · √20) = 0.031 s; the noise of 20 fixes is known to 20 %.
    EXPECT_NEAR(result.track->time_offset_s.std_error, 0.031, 0.012);
    EXPECT_NEAR(result.track->time_offset_s.value, clock_s, 2 * result.track->time_offset_s.std_error);
  }
}

/// A receiver that gives an altitude once in ten fixes.
TEST(TrackFixes, AltitudesThatLackLieBetweenTheOthers) {
  PoseGraphInput input = Drive{at_random_speed, 0.05}.input();
  for (std::size_t i = 0; i < input.fixes.size(); ++i) {
    input.fixes[i].position_m[2] = i % 10 == 0 ? 500 : std::nan("");
  }
  const PoseGraphResult result = optimise_poses(input);
  ASSERT_TRUE(result.track) << result.track_unused;
  EXPECT_NEAR(result.trajectory.frames[100].camera_to_world[11], 500, 0.1);
}

/// One wrong time of a frame, the first or one between, leaves out that frame alone.
TEST(TrackFixes, WrongTimeOfFrameCostsThatFrame) {
  for (const std::size_t wrong : {std::size_t{0}, std::size_t{100}}) {
    PoseGraphInput input = Drive{at_random_speed, 0.05}.input();
    input.times_s[wrong] = 1e6;
    const PoseGraphResult result = optimise_poses(input);
    ASSERT_TRUE(result.track) << result.track_unused;
    // 20 fixes of 0.05 m on either side: five times the standard error of their mean.
    for (const std::size_t frame : {std::size_t{20}, std::size_t{180}}) {
      EXPECT_NEAR(result.trajectory.frames[frame].camera_to_world[3], at_random_speed(0.1 * static_cast<double>(frame)),
                  0.06)
          << wrong;
    }
    EXPECT_LT(result.track->rms_m, 0.1);
  }
}

}  // namespace
}  // namespace roadstereo
