// Whether the surroundings of a region look like the region or like the road, on textures of known contrast.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "damage/texture_share.hpp"

namespace roadstereo {
namespace {

constexpr int picture_width = 320, picture_height = 240;
constexpr int verge_end = 160;  ///< first column of the road

/// White noise of a contrast on a verge to the left and another on the road, both of 1000/16 grey levels; darker by
/// half from `shadow` on.
GreyImage picture(double verge_contrast, double road_contrast, int shadow = picture_width) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  GreyImage grey(picture_width, picture_height);
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 0; u < picture_width; ++u) {
      const double level = 1000 * (1 + (u < verge_end ? verge_contrast : road_contrast) * noise(random));
      grey(u, v) = static_cast<std::int16_t>(std::lround(std::max(1.0, u < shadow ? level : 0.5 * level)));
    }
  }
  return grey;
}

/// Share of a region of 60×60 pixels whose first column is `u0`, where all is road.
double share_of(const GreyImage& grey, int u0) {
  DamageMap maps = make_empty_damage_map(picture_width, picture_height, "");
  maps.road.assign(picture_width, picture_height, 255);
  const PixelBox box{u0, 90, u0 + 59, 149};
  for (int v = box.v0; v <= box.v1; ++v) {
    for (int u = box.u0; u <= box.u1; ++u) maps.ids(u, v) = 1;
  }
  DamageInput input;
  input.grey = grey;
  return texture_share(input, maps, 1, box);
}

TEST(TextureShare, IsThatOfTheSameTextureAround) {
  // A verge of 106 columns: 0.80 of what lies within 46 pixels of the region is verge, 0.30 of the road region is.
  GreyImage grey = picture(0.3, 0.05);
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 106; u < verge_end; ++u) grey(u, v) = grey(u + verge_end, v);
  }
  EXPECT_NEAR(share_of(grey, 20), 0.5, 0.1);
  EXPECT_NEAR(share_of(grey, 200), 0, 0.1) << "on the road";
}

TEST(TextureShare, OfBumpOnTheRoadIsZero) {
  EXPECT_NEAR(share_of(picture(0.1, 0.1), 130), 0, 0.1);
  EXPECT_NEAR(share_of(picture(0.1, 0.1, 160), 130), 0, 0.1) << "half of it in a shadow";
}

/// Something of a third texture around a region is not of its own.
TEST(TextureShare, ThirdTextureIsNotThatOfTheInside) {
  GreyImage grey = picture(0.05, 0.05);
  const GreyImage rough = picture(0.5, 0.5), inner = picture(0.12, 0.12);
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 100; u < 150; ++u) grey(u, v) = rough(u, v);
    if (v < 90 || v >= 150) continue;
    for (int u = 150; u < 210; ++u) grey(u, v) = inner(u, v);
  }
  EXPECT_LT(share_of(grey, 150), 0.1);
}

TEST(TextureShare, IsUnknownWithoutAnImage) {
  EXPECT_TRUE(std::isnan(share_of({}, 20)));
}

}  // namespace
}  // namespace roadstereo
