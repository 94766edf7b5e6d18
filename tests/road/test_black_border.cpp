// What lies outside of the picture, on images with known borders.

#include <gtest/gtest.h>

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
  Image<std::uint8_t> found;
  ASSERT_TRUE(find_black_border(picture_with(outside), {}, found));
  for (int v = 0; v < picture_height; ++v) {
    for (int u = 0; u < picture_width; ++u) ASSERT_EQ(found(u, v) != 0, outside(u, v)) << u << ", " << v;
  }
}

TEST(BlackBorder, DarkPlacesInsidePictureAreNone) {
  const auto pothole = [](int u, int v) { return std::abs(u - 90) < 30 && std::abs(v - 70) < 20; };
  Image<std::uint8_t> found;
  EXPECT_FALSE(find_black_border(picture_with(pothole), {}, found));
}

TEST(BlackBorder, KeepsMask) {
  Image<std::uint8_t> mask(picture_width, picture_height, 0), found;
  mask(100, 60) = 1;
  ASSERT_TRUE(find_black_border(picture_with([](int u, int) { return u < 8; }), mask, found));
  EXPECT_EQ(found(100, 60), 255);
  EXPECT_EQ(found(7, 60), 255);
  EXPECT_EQ(found(8, 60), 0);
}

}  // namespace
}  // namespace roadstereo
