// What lies outside of the picture, on images with known borders.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "road/black_border.hpp"

namespace roadstereo {
namespace {

constexpr int picture_width = 200, picture_height = 120;

/// Grey 80, and black where `outside` says so.
template <class Outside>
GreyImage picture_with(const Outside& outside) {
  GreyImage grey(picture_width, picture_height, static_cast<std::int16_t>(80 * grey_scale));
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 0; u < picture_width; ++u) {
      if (outside(u, v)) grey(u, v) = static_cast<std::int16_t>((u + v) % 3 * grey_scale);  // of compression
    }
  }
  return grey;
}

TEST(BlackBorder, IsFoundOnAllSidesAndOfAnyShape) {
  // Sides that bend inwards, as rectification makes them, and a bar at the top.
  const auto outside = [](int u, int v) {
    const int bend = (v - 60) * (v - 60) / 180;
    return u < 4 + bend || u >= 190 - bend || v < 10;
  };
  const GreyImage grey = picture_with(outside);
  const PictureMask found(grey, {});
  ASSERT_FALSE(found.view().empty());
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 0; u < picture_width; ++u) ASSERT_EQ(found.view()(u, v) != 0, outside(u, v)) << u << ", " << v;
  }
}

TEST(BlackBorder, DarkPlacesInsidePictureAreNone) {
  const auto pothole = [](int u, int v) { return std::abs(u - 90) < 30 && std::abs(v - 70) < 20; };
  const GreyImage grey = picture_with(pothole);
  EXPECT_TRUE(PictureMask(grey, {}).view().empty());
}

/// A road at dusk, or of 12 bits in 16 that are taken for 16: everything is below three levels.
TEST(BlackBorder, DarkPictureIsNone) {
  GreyImage grey(picture_width, picture_height);
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 0; u < picture_width; ++u) grey(u, v) = static_cast<std::int16_t>(20 + (7 * u + 3 * v) % 20);
  }
  EXPECT_TRUE(PictureMask(grey, {}).view().empty());
  for (int v = 0; v < picture_height; ++v) std::fill_n(grey.row(v), 12, std::int16_t{0});
  const PictureMask found(grey, {});
  ASSERT_FALSE(found.view().empty());
  EXPECT_EQ(found.view()(11, 50), 255);
  EXPECT_EQ(found.view()(12, 50), 0);
}

TEST(BlackBorder, KeepsMask) {
  Image<std::uint8_t> mask(picture_width, picture_height, 0);
  mask(100, 60) = 1;
  const GreyImage grey = picture_with([](int u, int) { return u < 8; });
  const PictureMask found(grey, mask);
  ASSERT_FALSE(found.view().empty());
  EXPECT_EQ(found.view()(100, 60), 255);
  EXPECT_EQ(found.view()(7, 60), 255);
  EXPECT_EQ(found.view()(8, 60), 0);
}

}  // namespace
}  // namespace roadstereo
