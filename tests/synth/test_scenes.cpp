// Named and random scenes, and their texture.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>

#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

TEST(Texture, HasContrastAtEveryDistance) {
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

// Ids are of 16 bits, and 0 is none.
TEST(Scenes, RutsCountAmongDamagesOfSixteenBits) {
  Scene scene = bare_scene(75, 0);
  scene.road.ruts.assign(65535, Rut{});
  scene.road.blobs.assign(1, Blob{});
  try {
    scene.validate();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the road has 65536 damages; it must have at most 65535");
  }
}

TEST(Scenes, EverySceneRenders) {
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

TEST(Scenes, RolledSceneHasRoll) {
  const SyntheticPair pair = render(small_scene("rolled"));
  EXPECT_NEAR(pair.roll_rad, 8 * std::numbers::pi / 180, 1e-12);
  const double y_share = pair.plane.a1 / std::cos(pair.roll_rad);
  EXPECT_NEAR(pair.plane.a2, -y_share * std::sin(pair.roll_rad), 1e-15);
}

TEST(Scenes, RandomScenesAreValidAndRepeatable) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = random_scene(seed, seed % 2 == 1);
    EXPECT_NO_THROW(scene.validate()) << seed;
    EXPECT_GE(scene.road.blobs.size(), 1u);
    EXPECT_EQ(scene.rig.pitch_deg, random_scene(seed, seed % 2 == 1).rig.pitch_deg);
  }
  EXPECT_NE(random_scene(1).rig.width * random_scene(1).rig.pitch_deg,
            random_scene(2).rig.width * random_scene(2).rig.pitch_deg);
}

TEST(Scenes, RejectsBadValuesByName) {
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
