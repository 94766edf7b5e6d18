// Rows and columns that repeat the picture beside them, on pictures with known ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "road/black_border.hpp"
#include "road/repeated_border.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr int width = 320, height = 200;

/// Texture of 60 grey levels with noise of up to 4.
double asphalt(int u, int v) {
  return 80 + 60 * test::smooth_noise(u, v, 4, 1) + 4 * test::lattice(u, v, 2);
}

GreyImage painted(const std::function<double(int, int)>& level) {
  GreyImage grey(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      grey(u, v) = static_cast<std::int16_t>(std::clamp(std::lround(level(u, v)), 0L, 255L) * grey_scale);
    }
  }
  return grey;
}

/// What is painted at `at` of a side of `size` pixels, with `before` and `after` that repeat what lies between.
enum class Repeat { replicate, reflect, reflect_101 };

int source(int at, int size, int before, int after, Repeat how) {
  const int last = size - 1 - after;
  if (at >= before && at <= last) return at;
  const int beyond = at < before ? before - at : at - last, edge = at < before ? before : last;
  const int inwards = at < before ? 1 : -1;
  if (how == Repeat::replicate) return edge;
  return edge + inwards * (how == Repeat::reflect ? beyond - 1 : beyond);
}

void expect_border(const RepeatedBorder& found, int top, int bottom, int left, int right) {
  EXPECT_EQ(found.top, top);
  EXPECT_EQ(found.bottom, bottom);
  EXPECT_EQ(found.left, left);
  EXPECT_EQ(found.right, right);
}

TEST(RepeatedBorder, IsFoundOnAllSides) {
  for (const Repeat how : {Repeat::replicate, Repeat::reflect, Repeat::reflect_101}) {
    const GreyImage grey =
        painted([how](int u, int v) { return asphalt(source(u, width, 5, 17, how), source(v, height, 24, 3, how)); });
    expect_border(find_repeated_border(grey), 24, 3, 5, 17);
  }
}

TEST(RepeatedBorder, PictureHasNone) {
  expect_border(find_repeated_border(painted(asphalt)), 0, 0, 0, 0);
  // Two rows are no border.
  const auto two = [](int u, int v) { return asphalt(u, source(v, height, 0, 2, Repeat::replicate)); };
  expect_border(find_repeated_border(painted(two)), 0, 0, 0, 0);
}

TEST(RepeatedBorder, RowsThatDifferByNoiseArePicture) {
  // The same columns in every row, below noise of its own in every pixel: a picture that is blurred along its columns.
  const auto streaks = [](int u, int v) {
    const double row = v < 40 ? 0.0 : v;
    return 80 + 60 * test::smooth_noise(u, row, 4, 1) + 2 * test::lattice(u, v, 2);
  };
  expect_border(find_repeated_border(painted(streaks)), 0, 0, 0, 0);
}

TEST(RepeatedBorder, WithoutTextureThereIsNone) {
  expect_border(find_repeated_border(painted([](int, int) { return 128; })), 0, 0, 0, 0);
  // A saturated sky, with two poles, above a road.
  const auto sky = [](int u, int v) { return v < 60 ? (u / 7 == 20 || u / 9 == 8 ? 30 : 255) : asphalt(u, v); };
  expect_border(find_repeated_border(painted(sky)), 0, 0, 0, 0);
  // A gradient.
  expect_border(find_repeated_border(painted([](int u, int) { return u * 0.7; })), 0, 0, 0, 0);
}

TEST(RepeatedBorder, PatternsAreNone) {
  const auto stripes = [](int u, int) { return u % 4 < 2 ? 50 : 200; };
  const auto board = [](int u, int v) { return (u / 8 + v / 8) % 2 == 0 ? 50 : 200; };
  const auto waves = [](int u, int v) {
    return 128 + 60 * std::sin(2 * std::numbers::pi * u / 8) * std::cos(2 * std::numbers::pi * v / 10);
  };
  const auto magnified = [](int u, int v) { return 50 + 150 * test::lattice(u / 5, v / 5, 3); };
  const auto symmetric = [](int u, int v) { return asphalt(std::min(u, width - 1 - u), std::min(v, height - 1 - v)); };
  for (const std::function<double(int, int)>& level :
       {std::function<double(int, int)>(stripes), {board}, {waves}, {magnified}, {symmetric}}) {
    expect_border(find_repeated_border(painted(level)), 0, 0, 0, 0);
  }
}

TEST(RepeatedBorder, IsOutsideOfPicture) {
  const GreyImage grey = painted([](int u, int v) {
    return u < 6 ? 0 : asphalt(u, source(v, height, 0, 10, Repeat::reflect_101));  // and a black side
  });
  const PictureMask found(grey, {});
  ASSERT_FALSE(found.view().empty());
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) ASSERT_EQ(found.view()(u, v) != 0, u < 6 || v >= height - 10) << u << ", " << v;
  }
  EXPECT_TRUE(PictureMask(painted(asphalt), {}).view().empty());
}

}  // namespace
}  // namespace roadstereo
