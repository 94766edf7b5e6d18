#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "io/panels.hpp"
#include "roadstereo/io/pictures.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::io;

using Colour = std::array<int, 3>;  // blue, green, red

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

Colour colour_at(const Frame& frame, int u, int v) {
  const auto at = static_cast<std::size_t>((v * frame.width + u) * 3);
  return {frame.bytes[at], frame.bytes[at + 1], frame.bytes[at + 2]};
}

constexpr Colour black{0, 0, 0};

/// A road with a hole below it and a hump above it.
Image<float> transformed_road(int width, int height, float delta_t) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) map(u, v) = delta_t + 0.3f * static_cast<float>(std::sin(u * 1.7 + v * 2.3));
  }
  for (int v = height / 2; v < height / 2 + 20; ++v) {
    for (int u = 0; u < 20; ++u) {
      map(20 + u, v) = delta_t - 3;
      map(60 + u, v) = delta_t + 3;
    }
  }
  return map;
}

Image<float> road_disparity(int width, int height, const DisparityPlane& road) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) map(u, v) = static_cast<float>(road.disparity(u, v));
  }
  return map;
}

TEST(Pictures, ScaleSpansFirstToLastPercentile) {
  Image<float> map(101, 32, nan_value);
  for (int u = 0; u <= 100; ++u) map(u, 7) = static_cast<float>(u);
  const ColourScale scale = percentile_scale(map, "disparity, px");
  EXPECT_EQ(scale.lowest, 1);
  EXPECT_EQ(scale.highest, 99);
  EXPECT_FALSE(scale.diverging);
  EXPECT_EQ(scale.label, "disparity, px");
}

TEST(Pictures, EmptyAndFlatMapsHaveFiniteScale) {
  const Image<float> empty(40, 40, nan_value);
  const Image<float> flat(40, 40, 7.0f);
  EXPECT_GT(percentile_scale(empty, "").highest, percentile_scale(empty, "").lowest);
  EXPECT_GT(percentile_scale(flat, "").highest, percentile_scale(flat, "").lowest);
  for (const Image<float>* map : {&empty, &flat}) {
    const ColourScale scale = transformed_scale(*map, 7);
    EXPECT_EQ(scale.lowest, 6);
    EXPECT_EQ(scale.highest, 8);
  }
}

TEST(Pictures, TransformedScaleIsSymmetric) {
  const ColourScale scale = transformed_scale(transformed_road(320, 180, 30), 30);
  EXPECT_TRUE(scale.diverging);
  EXPECT_DOUBLE_EQ(scale.lowest + scale.highest, 60);
  EXPECT_NEAR(scale.highest, 33, 0.01);
}

TEST(Pictures, TransformedScaleIgnoresWalls) {
  Image<float> map = transformed_road(640, 360, 30);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 640; ++u) map(u, v) = 90;
  }
  EXPECT_LT(transformed_scale(map, 30).highest, 40);
}

TEST(Pictures, HolesAreRedBumpsBlueInvalidBlack) {
  Image<float> map = transformed_road(640, 360, 30);
  map(300, 10) = nan_value;
  map(301, 10) = 30;
  const Frame picture = colour_map(map, transformed_scale(map, 30));
  EXPECT_EQ(picture.order, ChannelOrder::bgr);
  EXPECT_EQ(picture.height, 360);
  EXPECT_GT(picture.width, 640);
  EXPECT_EQ(colour_at(picture, 300, 10), black);
  const auto [hole_blue, hole_green, hole_red] = colour_at(picture, 30, 185);
  EXPECT_GT(hole_red, hole_blue + 40);
  EXPECT_GT(hole_red, hole_green + 40);
  const auto [hump_blue, hump_green, hump_red] = colour_at(picture, 70, 185);
  EXPECT_GT(hump_blue, hump_red + 40);
  const auto [blue, green, red] = colour_at(picture, 301, 10);
  EXPECT_NEAR(blue, red, 8);
  EXPECT_NEAR(blue, green, 8);
  EXPECT_GT(blue, 180);
}

TEST(Pictures, ValidPixelsAreNeverBlack) {
  Image<float> map(64, 64);
  for (int v = 0; v < 64; ++v) {
    for (int u = 0; u < 64; ++u) map(u, v) = static_cast<float>(u + v);
  }
  for (const bool diverging : {false, true}) {
    const Frame picture = colour_map(map, {0, 126, diverging, "px"});
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        const auto [blue, green, red] = colour_at(picture, u, v);
        ASSERT_GT(blue + green + red, 60) << u << ", " << v;
      }
    }
  }
}

TEST(Pictures, EveryColourMapHasScaleBar) {
  for (const auto& [width, height] : {std::pair{32, 32}, {32, 400}, {400, 32}, {640, 360}, {2079, 1040}}) {
    const Image<float> map = road_disparity(width, height, {10, 0.1, 0});
    const Frame picture = colour_map(map, percentile_scale(map, "disparity, px"));
    EXPECT_GE(picture.height, height);
    EXPECT_GT(picture.width, width + 30);
    EXPECT_LT(picture.width, width + 80 + height / 5);
  }
}

/// The histogram in columns 100 … 499 and rows 0 … 399.
Frame v_disparity(const Image<float>& disparity, const std::optional<RollEstimate>& geometry) {
  cv::Mat canvas(500, 500, CV_8UC3, paper);
  draw_v_disparity(canvas, cv::Rect(100, 0, 400, 400), disparity, geometry, 12);
  return frame_from(canvas, ChannelOrder::bgr);
}

/// The line of the road model crosses the histogram where the closed form says.
TEST(Pictures, VDisparityShowsRoadLine) {
  const DisparityPlane road{20, 0.2, 0};
  RollEstimate geometry;
  geometry.plane = road;
  const Image<float> map = road_disparity(640, 400, road);
  const Frame lined = v_disparity(map, geometry);
  // Without roll every pixel of a row falls on the line: what the line changes lies on bright pixels or
  // beside them.
  int coloured = 0;
  int first_u = lined.width;
  int last_u = 0;
  for (int v = 150; v < lined.height; ++v) {
    for (int u = 0; u < lined.width; ++u) {
      const auto [blue, green, red] = colour_at(lined, u, v);
      if (red < blue + 40) continue;
      ++coloured;
      first_u = std::min(first_u, u);
      last_u = std::max(last_u, u);
    }
  }
  EXPECT_GT(coloured, 200);
  EXPECT_GT(last_u - first_u, 100);
}

TEST(Pictures, VDisparityOfEmptyMapIsValid) {
  const Frame picture = v_disparity(Image<float>(64, 48, nan_value), std::nullopt);
  EXPECT_EQ(colour_at(picture, 300, 200), black);
}

TEST(Pictures, ResultSheetHasBoundedSize) {
  for (const auto& [width, height] : {std::pair{32, 32}, {1242, 375}, {2079, 1040}, {480, 640}, {4000, 100}}) {
    const DisparityPlane road{5, 0.1, 0.01};
    RollEstimate geometry;
    geometry.plane = road;
    const Image<float> disparity = road_disparity(width, height, road);
    const Image<float> transformed(width, height, 10.0f);
    for (const ChannelOrder order : {ChannelOrder::grey, ChannelOrder::rgba}) {
      Frame left{{}, width, height, SampleType::u16, order};
      left.bytes.assign(static_cast<std::size_t>(left.view().stride_bytes) * static_cast<std::size_t>(height), 3);
      const Frame sheet =
          result_sheet(left.view(), 0, disparity, transformed, 10, geometry, "a title that is rather long, ψ 3.1°");
      EXPECT_GE(sheet.width, 1600);
      EXPECT_LE(sheet.width, 2400);
      EXPECT_GE(sheet.height, 600);
      EXPECT_LE(sheet.height, 2400);
    }
  }
}

TEST(Pictures, ResultSheetOfEmptyResultIsValid) {
  const Image<float> nothing(640, 360, nan_value);
  const Frame left{std::vector<std::uint8_t>(640 * 360, 80), 640, 360, SampleType::u8, ChannelOrder::grey};
  const Frame sheet = result_sheet(left.view(), 0, nothing, nothing, 0, std::nullopt, "");
  EXPECT_GE(sheet.width, 1600);
}

}  // namespace
