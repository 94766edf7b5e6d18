// Glint: light that one camera sees and the other does not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "damage/specular_excess.hpp"
#include "roadstereo/grey_scale.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

constexpr int road_grey = 16 * 100;                // 1/16 grey level
constexpr PixelBox region{100, 60, 139, 89};       // of damage 1
constexpr PixelBox with_windows{90, 50, 149, 99};  // and of the windows of its pixels
constexpr int width = 240, height = 160, disparity_px = 20;

/// A road of one brightness in both images, and a region of damage 1.
struct EvenPair {
  GreyImage left{width, height}, right{width, height};
  Image<float> disparity{width, height};
  DamageMap map = make_empty_damage_map(width, height, "");

  explicit EvenPair(int right_grey = road_grey) {
    std::fill_n(left.row(0), left.pixels(), static_cast<std::int16_t>(road_grey));
    std::fill_n(right.row(0), right.pixels(), static_cast<std::int16_t>(right_grey));
    std::fill_n(disparity.row(0), disparity.pixels(), static_cast<float>(disparity_px));
    std::fill_n(map.road.row(0), map.road.pixels(), std::uint8_t{255});
    for (int v = region.v0; v <= region.v1; ++v)
      std::fill_n(map.ids.row(v) + region.u0, region.width(), std::uint16_t{1});
  }

  /// Grey levels of what the windows of the region see, in both images.
  void paint(int left_grey, int right_grey) {
    for (int v = with_windows.v0; v <= with_windows.v1; ++v) {
      std::fill_n(left.row(v) + with_windows.u0, with_windows.width(), static_cast<std::int16_t>(left_grey));
      std::fill_n(right.row(v) + with_windows.u0 - disparity_px, with_windows.width(),
                  static_cast<std::int16_t>(right_grey));
    }
  }

  double excess() const {
    DamageInput input;
    input.transformed = input.disparity = disparity;
    input.grey = left;
    input.right = right;
    return specular_excess(input, map, 1, region);
  }
};

TEST(SpecularExcess, LightInOneImageIsMeasuredInBrightnessesOfTheRoad) {
  EvenPair pair;
  EXPECT_EQ(pair.excess(), 0);
  pair.paint(road_grey * 3 / 2, road_grey);
  EXPECT_NEAR(pair.excess(), 0.5, 1e-9);
  pair.paint(road_grey, road_grey * 3 / 2);
  EXPECT_NEAR(pair.excess(), 0.5, 1e-9);
  pair.paint(road_grey * 7 / 4, road_grey * 3 / 2);  // glint in both, brighter in one
  EXPECT_NEAR(pair.excess(), 0.25, 1e-9);
}

TEST(SpecularExcess, WhatIsDarkerThanTheRoadOrBrightInBothIsNoGlint) {
  EvenPair pair;
  pair.paint(road_grey / 2, road_grey / 4);  // a hole in which light differs
  EXPECT_EQ(pair.excess(), 0);
  pair.paint(road_grey * 2, road_grey * 2);  // paint
  EXPECT_EQ(pair.excess(), 0);
}

TEST(SpecularExcess, ExposureOfOneCameraIsUndone) {
  EvenPair pair(road_grey * 3 / 2);
  EXPECT_NEAR(pair.excess(), 0, 1e-9);
  pair.paint(road_grey * 3 / 2, road_grey * 3 / 2);
  EXPECT_NEAR(pair.excess(), 0.5, 1e-9);
}

/// Paint that the brighter camera shows white, and no brighter than that.
TEST(SpecularExcess, WhatIsWhiteInOneImageIsNoGlint) {
  EvenPair pair(road_grey * 2);
  pair.paint(road_grey * 3 / 2, grey_max);
  EXPECT_LT(pair.excess(), 0.01);
}

TEST(SpecularExcess, UnknownWithoutARightImageOrARoadAround) {
  EvenPair pair;
  std::fill_n(pair.map.road.row(0), pair.map.road.pixels(), std::uint8_t{0});
  for (int v = region.v0; v <= region.v1; ++v) {
    std::fill_n(pair.map.road.row(v) + region.u0, region.width(), std::uint8_t{255});
  }
  EXPECT_TRUE(std::isnan(pair.excess()));
  DamageInput input;
  input.transformed = input.disparity = pair.disparity;
  input.grey = pair.left;
  EXPECT_TRUE(std::isnan(specular_excess(input, pair.map, 1, region)));
}

TEST(DamageEvidence, GlintIsNoDamage) {
  DamageEvidence evidence{20, 90, 3, 1, 0};
  const double unknown = evidence.confidence();
  evidence.specular_excess = 0.03;
  EXPECT_EQ(evidence.confidence(), unknown);
  evidence.specular_excess = 0.2;
  EXPECT_LT(evidence.confidence(), 0.05);
}

}  // namespace
}  // namespace roadstereo
