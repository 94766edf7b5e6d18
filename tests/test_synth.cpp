#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::synth {
namespace {

/// A small rig without anything on the road.
Scene bare_scene(double pitch_deg, double roll_deg) {
  Scene scene;
  scene.rig.width = 128;
  scene.rig.height = 96;
  scene.rig.focal_px = 100;
  scene.rig.camera_height_m = 1.5;
  scene.rig.pitch_deg = pitch_deg;
  scene.rig.roll_deg = roll_deg;
  scene.road.lane_marking = false;
  scene.supersampling = 1;
  return scene;
}

/// The named scene at a quarter of its pixels.
Scene small_scene(const std::string& name) {
  Scene scene = named_scene(name);
  scene.rig.width /= 4;
  scene.rig.height /= 4;
  scene.rig.focal_px /= 4;
  scene.supersampling = 2;
  return scene;
}

double grey(const Frame& frame, int u, int v) {
  return frame.bytes[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(u)];
}

double mean_grey(const Frame& frame) {
  double sum = 0;
  for (const std::uint8_t byte : frame.bytes) sum += byte;
  return sum / static_cast<double>(frame.bytes.size());
}

/// Value between the pixels of a row: cubic convolution over four pixels.
double cubic_sample(const Frame& frame, double u, int v) {
  const int left = static_cast<int>(std::floor(u));
  const double t = u - left;
  const double a = grey(frame, left - 1, v);
  const double b = grey(frame, left, v);
  const double c = grey(frame, left + 1, v);
  const double d = grey(frame, left + 2, v);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// RMS difference of left(u) and right(u − d − shift) over the pixels that both cameras see.
double warp_rms(const SyntheticPair& pair, double shift) {
  double sum = 0;
  int count = 0;
  for (int v = 0; v < pair.left.height; ++v) {
    for (int u = 0; u < pair.left.width; ++u) {
      const double target = u - pair.disparity(u, v) - shift;
      if (pair.visible(u, v) == 0 || !(target >= 2 && target <= pair.left.width - 4)) continue;
      const double difference = grey(pair.left, u, v) - cubic_sample(pair.right, target, v);
      sum += difference * difference;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

/// Shift of least RMS difference: what a perfect matcher would find wrong with the truth.
double best_shift(const SyntheticPair& pair) {
  constexpr double h = 0.1;
  const auto energy = [&](double shift) { return std::pow(warp_rms(pair, shift), 2); };
  const double below = energy(-h);
  const double here = energy(0);
  const double above = energy(h);
  return h * 0.5 * (below - above) / (below - 2 * here + above);
}

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Synth, FrontoParallelPlaneHasOneDisparity) {
  const Scene scene = bare_scene(90, 0);
  const SyntheticPair pair = render(scene);
  const double expected = 100 * 0.12 / 1.5;
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) ASSERT_NEAR(pair.disparity(u, v), expected, 1e-9);
  }
  EXPECT_EQ(pair.plane.a1, 0);
  EXPECT_EQ(pair.plane.a2, 0);
  EXPECT_EQ(pair.roll_rad, 0);
}

TEST(Synth, PlaneDisparityFollowsTheHomography) {
  for (const auto& [pitch, roll] : {std::pair{60.0, 0.0}, {60.0, 8.0}, {35.0, -5.0}, {80.0, 20.0}}) {
    const SyntheticPair pair = render(bare_scene(pitch, roll));
    // The plane n·P = h in the camera's frame, n pointing down: undo the roll, then the pitch.
    const double p = pitch * std::numbers::pi / 180;
    const double r = roll * std::numbers::pi / 180;
    const std::array<double, 3> n{-std::sin(r) * std::cos(p), std::cos(r) * std::cos(p), std::sin(p)};
    for (int v = 0; v < 96; ++v) {
      for (int u = 0; u < 128; ++u) {
        const double x = (u - 63.5) / 100;
        const double y = (v - 47.5) / 100;
        const double inverse_depth = (n[0] * x + n[1] * y + n[2]) / 1.5;
        if (inverse_depth < 1e-2) continue;
        ASSERT_NEAR(pair.disparity(u, v), 100 * 0.12 * inverse_depth, 1e-9);
        ASSERT_NEAR(pair.plane.disparity(u, v), pair.disparity(u, v), 1e-9);
      }
    }
    EXPECT_NEAR(pair.roll_rad, r, 1e-12);
    EXPECT_NEAR(pair.roll_rad, std::atan(-pair.plane.a2 / pair.plane.a1), 1e-15);
  }
}

TEST(Synth, PlaceOnTheRoadDoesNotChangeAPlane) {
  Scene scene = bare_scene(50, 3);
  const SyntheticPair here = render(scene);
  scene.rig.x_m = 12;
  scene.rig.y_m = 345;
  const SyntheticPair there = render(scene);
  EXPECT_NEAR(here.disparity(5, 90), there.disparity(5, 90), 1e-12);
  EXPECT_NE(here.left.bytes, there.left.bytes);
}

TEST(Synth, CamberAndKerbFollowTheirFormula) {
  Scene scene = bare_scene(60, 4);
  scene.road.camber = 0.02;
  scene.road.kerbs = {{0.3, 0.1, 0.02}};
  const SyntheticPair pair = render(scene);
  const double p = 60 * std::numbers::pi / 180;
  const double r = 4 * std::numbers::pi / 180;
  for (int v = 0; v < 96; v += 5) {
    for (int u = 0; u < 128; u += 5) {
      const auto [x, y, z] = pair.calibration.point_m(u, v, pair.disparity(u, v));
      // Back to the road: undo the roll, then the pitch.
      const double level_x = std::cos(r) * x + std::sin(r) * y;
      const double level_y = -std::sin(r) * x + std::cos(r) * y;
      const double road_z = 1.5 - std::cos(p) * level_y - std::sin(p) * z;
      const double kerb = 0.1 * std::clamp((level_x - 0.3) / 0.02, 0.0, 1.0);
      EXPECT_NEAR(road_z, kerb - 0.02 * level_x * level_x, 1e-12) << u << ' ' << v;
    }
  }
}

TEST(Synth, TruthLiesOnTheBlob) {
  Scene scene = bare_scene(90, 0);
  scene.road.blobs = {{0.2, 0.1, 0.4, 0.1, 0, 0.25, 1}};
  const SyntheticPair pair = render(scene);
  int on_wall = 0;
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) {
      const auto [x, y, z] = pair.calibration.point_m(u, v, pair.disparity(u, v));
      const double q = std::clamp((1 - std::hypot(x - 0.2, -y - 0.1) / 0.4) / 0.25, 0.0, 1.0);
      ASSERT_NEAR(z, 1.5 + 0.1 * q * q * (3 - 2 * q), 2e-12);
      ASSERT_EQ(pair.labels(u, v), q > 0 ? 1 : 0);
      on_wall += q > 0 && q < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(on_wall, 100);
}

TEST(Synth, BlobIsMeasuredAsItsIntegral) {
  for (const double wall : {0.1, 0.4, 1.0}) {
    Scene scene = bare_scene(70, 0);
    scene.road.blobs = {{0.1, 0.5, 0.3, 0.08, 0, wall, 1}, {-0.6, 0.9, 0.2, -0.03, 0, wall, 2}};
    const SyntheticPair pair = render(scene);
    ASSERT_EQ(pair.damages.size(), 2u);
    const double disc = std::numbers::pi * 0.3 * 0.3;
    // ∫ of the cubic wall over the disc: π R² h (1 − w + 0.3 w²).
    const double volume = disc * 0.08 * (1 - wall + 0.3 * wall * wall);
    EXPECT_EQ(pair.damages[0].kind, "pothole");
    EXPECT_EQ(pair.damages[0].id, 1);
    EXPECT_NEAR(pair.damages[0].area_m2, disc, 1e-3 * disc);
    EXPECT_NEAR(pair.damages[0].volume_m3, volume, 1e-4 * volume);
    EXPECT_NEAR(pair.damages[0].mean_depth_m, volume / disc, 2e-3 * volume / disc);
    EXPECT_NEAR(pair.damages[0].depth_m, 0.08, 1e-5);
    EXPECT_NEAR(pair.damages[0].x_m, 0.1, 1e-4);
    EXPECT_NEAR(pair.damages[0].y_m, 0.5, 1e-4);
    EXPECT_EQ(pair.damages[1].kind, "bump");
    EXPECT_NEAR(pair.damages[1].depth_m, 0.03, 1e-5);
  }
}

TEST(Synth, CrackIsMeasuredAsItsIntegral) {
  Scene scene = bare_scene(70, 0);
  scene.road.cracks = {{{{-0.3, 0.3}, {0.4, 0.8}}, 0.02, 0.03}};
  const SyntheticPair pair = render(scene);
  ASSERT_EQ(pair.damages.size(), 1u);
  const double length = std::hypot(0.7, 0.5);
  const double cap = std::numbers::pi * 0.01 * 0.01;
  const double area = length * 0.02 + cap;
  const double volume = length * 0.02 * 0.03 / 2 + cap * 0.03 / 3;
  EXPECT_EQ(pair.damages[0].kind, "crack");
  EXPECT_NEAR(pair.damages[0].area_m2, area, 5e-3 * area);
  EXPECT_NEAR(pair.damages[0].volume_m3, volume, 5e-3 * volume);
  EXPECT_NEAR(pair.damages[0].depth_m, 0.03, 1e-3);
}

TEST(Synth, TruthWarpsRightOntoLeft) {
  for (const char* name : {"flat", "rolled", "nadir", "close", "street"}) {
    Scene scene = small_scene(name);
    scene.rig.width *= 2;
    scene.rig.height *= 2;
    scene.rig.focal_px *= 2;
    scene.supersampling = 3;
    const SyntheticPair pair = render(scene);
    const double exact = warp_rms(pair, 0);
    EXPECT_LT(exact, 2.5) << name;
    EXPECT_GT(warp_rms(pair, 1), 3.5 * exact) << name;
    EXPECT_GT(warp_rms(pair, -1), 3.5 * exact) << name;
    // Straight down all pixels share one fraction, and with it the error of the cubic interpolation.
    EXPECT_NEAR(best_shift(pair), 0, name == std::string("nadir") ? 0.02 : 0.005) << name;
  }
}

TEST(Synth, RowOffsetMovesTheRightPictureDown) {
  Scene scene = small_scene("uav");
  const SyntheticPair straight = render(scene);
  scene.degradation.row_offset_px = 2;
  const SyntheticPair moved = render(scene);
  EXPECT_EQ(straight.left.bytes, moved.left.bytes);
  EXPECT_EQ(straight.disparity, moved.disparity);
  // A whole number of rows: the same rays, but for the last digits of their rows.
  double worst = 0;
  for (int v = 2; v < scene.rig.height; ++v) {
    for (int u = 0; u < scene.rig.width; ++u) {
      worst = std::max(worst, std::abs(grey(moved.right, u, v) - grey(straight.right, u, v - 2)));
    }
  }
  EXPECT_LE(worst, 1);
  EXPECT_EQ(moved.visible(scene.rig.width / 2, scene.rig.height - 1), 0);
}

TEST(Synth, HiddenPixelsAreInvisible) {
  Scene scene = bare_scene(90, 0);
  scene.rig.baseline_m = 0.5;
  scene.rig.focal_px = 60;
  // A steep wall: the right camera does not see what lies left of it.
  scene.road.blobs = {{0.3, 0, 0.3, -0.4, 0, 0.05, 1}};
  const SyntheticPair pair = render(scene);
  int hidden = 0;
  for (int u = 0; u < 128; ++u) {
    const auto [x, y, z] = pair.calibration.point_m(u, 47, pair.disparity(u, 47));
    const double target = u - pair.disparity(u, 47);
    if (target < 0) {
      EXPECT_EQ(pair.visible(u, 47), 0) << u;
      continue;
    }
    if (pair.labels(u, 47) != 0 || std::abs(x) > 1.2) continue;
    // The ground's line of sight to the right camera at (0.5, 1.5 m up) passes the top, 0.4 m high, out to x
    // = 0.585.
    const double at_top = x + (0.5 - x) * 0.4 / 1.5;
    const bool blocked = at_top > 0.02 && at_top < 0.58;
    const bool free = at_top < -0.01 || at_top > 0.61;
    if (blocked) {
      EXPECT_EQ(pair.visible(u, 47), 0) << u << " x " << x;
      ++hidden;
    }
    if (free) {
      EXPECT_EQ(pair.visible(u, 47), 255) << u << " x " << x;
    }
  }
  EXPECT_GE(hidden, 3);
  EXPECT_EQ(pair.visible(2, 5), 0) << "the left border is outside the right image";
}

TEST(Synth, SkyHasNoDisparity) {
  const SyntheticPair pair = render(small_scene("street"));
  EXPECT_TRUE(std::isnan(pair.disparity(100, 0)));
  EXPECT_EQ(pair.visible(100, 0), 0);
  EXPECT_FALSE(std::isnan(pair.disparity(100, pair.left.height - 1)));
}

TEST(Synth, ThreadsAndRepetitionDoNotChangeAnything) {
  Scene scene = random_scene(5, true);
  scene.rig.width = 160;
  scene.rig.height = 96;
  scene.rig.focal_px = 90;
  scene.degradation.noise_grey = 3;
  scene.degradation.blur_px = 0.7;
  scene.degradation.motion_blur_px = 2;
  const SyntheticPair one = render(scene, 1);
  for (const int threads : {1, 2, 5}) {
    const SyntheticPair other = render(scene, threads);
    EXPECT_EQ(one.left.bytes, other.left.bytes);
    EXPECT_EQ(one.right.bytes, other.right.bytes);
    EXPECT_EQ(one.labels, other.labels);
    EXPECT_EQ(one.visible, other.visible);
    for (int v = 0; v < 96; ++v) {
      for (int u = 0; u < 160; ++u) {
        const double a = one.disparity(u, v);
        const double b = other.disparity(u, v);
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
      }
    }
  }
}

TEST(Synth, NoiseHasItsDeviationAndItsSeed) {
  Scene scene = small_scene("flat");
  const SyntheticPair clean = render(scene);
  scene.degradation.noise_grey = 6;
  const SyntheticPair noisy = render(scene);
  double sum = 0;
  double squares = 0;
  double product = 0;
  const auto n = static_cast<double>(clean.left.bytes.size());
  for (std::size_t i = 0; i < clean.left.bytes.size(); ++i) {
    const double left = double{1} * noisy.left.bytes[i] - clean.left.bytes[i];
    const double right = double{1} * noisy.right.bytes[i] - clean.right.bytes[i];
    sum += left;
    squares += left * left;
    product += left * right;
  }
  EXPECT_NEAR(sum / n, 0, 0.2);
  EXPECT_NEAR(std::sqrt(squares / n), 6, 0.2);
  EXPECT_NEAR(product / n, 0, 1.5) << "the two cameras' noise is independent";
  scene.degradation.noise_seed = 2;
  EXPECT_NE(render(scene).left.bytes, noisy.left.bytes);
}

TEST(Synth, GainAndExposureScaleThePictures) {
  Scene scene = small_scene("flat");
  const SyntheticPair clean = render(scene);
  scene.degradation.gain_difference = 0.15;
  const SyntheticPair uneven = render(scene);
  EXPECT_EQ(clean.left.bytes, uneven.left.bytes);
  EXPECT_NEAR(mean_grey(uneven.right) / mean_grey(clean.right), 1.15, 0.003);
  scene.degradation.gain_difference = 0;
  scene.degradation.exposure = 0.5;
  EXPECT_NEAR(mean_grey(render(scene).left) / mean_grey(clean.left), 0.5, 0.003);
  scene.degradation.exposure = 10;
  EXPECT_EQ(mean_grey(render(scene).left), 255);
}

TEST(Synth, BlurKeepsTheMeanAndTakesContrast) {
  const auto variation = [](const Frame& frame) {
    double sum = 0;
    for (int v = 1; v < frame.height; ++v) {
      for (int u = 1; u < frame.width; ++u) {
        sum += std::pow(grey(frame, u, v) - grey(frame, u - 1, v), 2) +
               std::pow(grey(frame, u, v) - grey(frame, u, v - 1), 2);
      }
    }
    return sum;
  };
  Scene scene = small_scene("flat");
  const Frame clean = render(scene).left;
  scene.degradation.blur_px = 1.5;
  const Frame blurred = render(scene).left;
  EXPECT_NEAR(mean_grey(blurred), mean_grey(clean), 0.5);
  EXPECT_LT(variation(blurred), 0.25 * variation(clean));
  scene.degradation.blur_px = 0;
  scene.degradation.motion_blur_px = 5;
  const Frame moved = render(scene).left;
  EXPECT_NEAR(mean_grey(moved), mean_grey(clean), 0.5);
  EXPECT_LT(variation(moved), 0.7 * variation(clean));
}

TEST(Synth, TextureHasContrastAtEveryDistance) {
  for (const double height : {0.5, 1.5, 5.0, 15.0, 40.0}) {
    Scene scene = bare_scene(75, 0);
    scene.rig.camera_height_m = height;
    scene.supersampling = 3;
    const Frame left = render(scene).left;
    double deviation = 0;
    int windows = 0;
    for (int v = 5; v + 5 < left.height; v += 11) {
      for (int u = 5; u + 5 < left.width; u += 11, ++windows) {
        double sum = 0;
        double squares = 0;
        for (int j = -5; j <= 5; ++j) {
          for (int i = -5; i <= 5; ++i) {
            sum += grey(left, u + i, v + j);
            squares += std::pow(grey(left, u + i, v + j), 2);
          }
        }
        deviation += std::sqrt(squares / 121 - sum * sum / (121 * 121));
      }
    }
    EXPECT_GT(deviation / windows, 6) << height << " m";
    EXPECT_LT(deviation / windows, 20) << height << " m";
  }
}

TEST(Synth, EverySceneRenders) {
  std::set<std::string> names;
  for (const std::string& name : scene_names()) {
    names.insert(name);
    Scene scene = small_scene(name);
    EXPECT_EQ(scene.name, name);
    scene.supersampling = 1;
    const SyntheticPair pair = render(scene);
    EXPECT_EQ(pair.left.bytes.size(), pair.disparity.pixels()) << name;
    EXPECT_EQ(pair.damages.size(), scene.road.blobs.size() + scene.road.cracks.size()) << name;
    std::set<int> seen;
    for (int v = 0; v < scene.rig.height; ++v) {
      for (int u = 0; u < scene.rig.width; ++u) seen.insert(pair.labels(u, v));
    }
    EXPECT_TRUE(seen.contains(0)) << name;
    for (std::size_t i = 1; i <= scene.road.blobs.size(); ++i) {
      EXPECT_TRUE(seen.contains(static_cast<int>(i))) << name << " does not see blob " << i;
    }
  }
  for (const char* name : {"demo", "uav", "street", "nadir", "close", "flat", "low_texture", "noise", "blur",
                           "motion_blur", "overexposed", "gain", "rolled", "row_offset"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(Synth, RolledSceneHasItsRoll) {
  const SyntheticPair pair = render(small_scene("rolled"));
  EXPECT_NEAR(pair.roll_rad, 8 * std::numbers::pi / 180, 1e-12);
  const double y_share = pair.plane.a1 / std::cos(pair.roll_rad);
  EXPECT_NEAR(pair.plane.a2, -y_share * std::sin(pair.roll_rad), 1e-15);
}

TEST(Synth, RandomScenesAreSoundAndRepeatable) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = random_scene(seed, seed % 2 == 1);
    EXPECT_NO_THROW(scene.validate()) << seed;
    EXPECT_GE(scene.road.blobs.size(), 1u);
    EXPECT_EQ(scene.rig.pitch_deg, random_scene(seed, seed % 2 == 1).rig.pitch_deg);
  }
  EXPECT_NE(random_scene(1).rig.width * random_scene(1).rig.pitch_deg,
            random_scene(2).rig.width * random_scene(2).rig.pitch_deg);
}

TEST(Synth, FramesMoveAlongTheRoad) {
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

TEST(Synth, AFlightRollsPitchesAndClimbs) {
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

TEST(Synth, AFlightJumpsAndJumpsBack) {
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

TEST(Synth, BadFlightsAreRefusedByName) {
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

TEST(Synth, BadScenesAreRefusedByName) {
  const auto complaint = [](const auto& spoil) {
    Scene scene = named_scene("uav");
    spoil(scene);
    return message_of([&] { render(scene); });
  };
  EXPECT_NE(complaint([](Scene& s) { s.rig.pitch_deg = 91; }).find("pitch_deg is 91"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.rig.focal_px = NAN; }).find("focal_px"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.rig.width = 31; }).find("width is 31"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.rig.camera_height_m = 0; }).find("camera_height_m"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.road.blobs[1].irregularity = 0.7; }).find("blob 2: irregularity is 0.7"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.road.blobs[0].depth_m = 0; }).find("depth_m"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.road.cracks[0].points_m.resize(1); }).find("at least 2"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.degradation.exposure = 0; }).find("exposure is 0"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.supersampling = 9; }).find("supersampling is 9"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) {
              s.rig.camera_height_m = 0.3;
              s.road.blobs = {{0, 0, 0.5, -0.4, 0, 0.2, 1}};
            }).find("above the surface"),
            std::string::npos);
  EXPECT_NE(message_of([] { named_scene("stret"); }).find("\"street\""), std::string::npos);
  EXPECT_NE(message_of([] { next_frame(named_scene("flat"), -1); }).find("frame"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo::synth
