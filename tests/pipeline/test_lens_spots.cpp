// Dirt on a lens and dead pixels are told from what moves, and from what never moves.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "roadstereo/health.hpp"
#include "roadstereo/lens_spots.hpp"

namespace roadstereo {
namespace {

constexpr int width = 320, height = 180;

/// Grey levels of a long road that is smooth over a few pixels; row 0 is the farthest.
const GreyImage& road() {
  static const GreyImage texture = [] {
    constexpr int length = 1200;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> level(60, 190);
    Image<int> white(width, length);
    for (int v = 0; v < length; ++v) {
      for (int u = 0; u < width; ++u) white(u, v) = level(random);
    }
    GreyImage smooth(width, length, static_cast<std::int16_t>(grey_max / 2));
    for (int v = 3; v + 3 < length; ++v) {
      for (int u = 3; u + 3 < width; ++u) {
        int sum = 0;
        for (int y = v - 3; y <= v + 3; ++y) {
          for (int x = u - 3; x <= u + 3; ++x) sum += white(x, y);
        }
        smooth(u, v) = static_cast<std::int16_t>(grey_max * (125 + 3 * (sum / 49.0 - 125)) / 255);
      }
    }
    return smooth;
  }();
  return texture;
}

GreyImage frame_at(int metres, int columns) {
  GreyImage frame(columns, height);
  for (int v = 0; v < height; ++v) std::copy_n(road().row(v + metres), columns, frame.row(v));
  return frame;
}

void darken(GreyImage& frame, double u, double v, double radius, double share) {
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      if (std::hypot(x - u, y - v) > radius) continue;
      frame(x, y) = static_cast<std::int16_t>((1 - share) * frame(x, y) + share * grey_max * 20 / 255);
    }
  }
}

constexpr std::array<std::array<double, 3>, 6> specks{
    {{40, 30, 6}, {150, 60, 5}, {300, 90, 6}, {80, 120, 5}, {220, 140, 9}, {120, 168, 5}}};

template <class Spoil>
LensSpots spots_after(int frames, int rows_per_frame, const Spoil& spoil, int columns = width) {
  LensWatch watch;
  for (int i = 0; i < frames; ++i) {
    GreyImage frame = frame_at(1000 - rows_per_frame * i, columns);
    spoil(frame);
    watch.add(frame);
  }
  return watch.spots();
}

TEST(LensWatch, CountsSixSpecksAfterTwentyFrames) {
  const auto spoil = [](GreyImage& frame) {
    for (const auto& [u, v, radius] : specks) darken(frame, u, v, radius, 0.8);
  };
  EXPECT_TRUE(std::isnan(spots_after(19, 9, spoil).dirt));
  const LensSpots spots = spots_after(20, 9, spoil);
  EXPECT_EQ(spots.dirt, 6);
  EXPECT_EQ(spots.dead_pixels, 0);
  EXPECT_NEAR(spots.largest_u, 220, 2);
  EXPECT_NEAR(spots.largest_v, 140, 2);
  PairHealth health;
  health.spots.left = spots;
  ASSERT_EQ(health.findings().size(), 1U);
  EXPECT_EQ(health.findings()[0].id, "left-spots");
  EXPECT_EQ(health.findings()[0].value, 6);
  EXPECT_NE(health.findings()[0].text.find("6 places of the left picture"), std::string::npos);
  EXPECT_TRUE(health.depth_is_trusted());
}

/// At widths whose cells are one and two pixels.
TEST(LensWatch, LargeSpotsAreSeenAsSmallOnesAre) {
  for (const int columns : {319, 320}) {
    for (const double share : {0.03, 0.06, 0.12, 0.2}) {
      const LensSpots spots = spots_after(
          20, 9, [&](GreyImage& frame) { darken(frame, 150, 80, 0.5 * share * columns, 0.8); }, columns);
      EXPECT_EQ(spots.dirt, 1) << columns << " " << share;
      EXPECT_NEAR(spots.largest_u, 150, 2) << columns << " " << share;
      EXPECT_NEAR(spots.largest_v, 80, 2) << columns << " " << share;
    }
  }
}

TEST(LensWatch, CleanViewHasNone) {
  const LensSpots spots = spots_after(60, 9, [](GreyImage&) {});
  EXPECT_EQ(spots.dirt, 0);
  EXPECT_EQ(spots.dead_pixels, 0);
}

TEST(LensWatch, StandingVehicleTellsNothing) {
  const auto spoil = [](GreyImage& frame) { darken(frame, 150, 60, 5, 0.8); };
  EXPECT_TRUE(std::isnan(spots_after(100, 0, spoil).dirt));
}

TEST(LensWatch, BonnetSkyAndLineAreNoDirt) {
  const LensSpots spots = spots_after(40, 9, [](GreyImage& frame) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const bool is_bonnet = std::hypot(u - 160, 2.0 * (v - 200)) < 100, is_sky = v < 30;
        const bool is_line = std::abs(u - 300 + 0.9 * v) < 6;
        if (is_sky || is_line) frame(u, v) = 3600;
        if (is_bonnet) frame(u, v) = static_cast<std::int16_t>(1000 + 300 * ((u ^ v) & 1));
      }
    }
  });
  EXPECT_EQ(spots.dirt, 0);
  EXPECT_EQ(spots.dead_pixels, 0);
}

TEST(LensWatch, CountsDeadPixels) {
  const LensSpots spots = spots_after(20, 9, [](GreyImage& frame) {
    for (int i = 0; i < 50; ++i) frame(5 + 6 * i, 7 + 3 * i) = static_cast<std::int16_t>(i % 2 == 0 ? 0 : grey_max);
  });
  EXPECT_EQ(spots.dirt, 0);
  EXPECT_EQ(spots.dead_pixels, 50);
  EXPECT_EQ(spots.largest_u, 5);
  EXPECT_EQ(spots.largest_v, 7);
  PairHealth health;
  health.spots.right = spots;
  ASSERT_EQ(health.findings().size(), 1U);
  EXPECT_EQ(health.findings()[0].id, "right-spots");
  EXPECT_EQ(health.findings()[0].value, 50);
  health.spots.right.dead_share = 1e-4;
  EXPECT_TRUE(health.findings().empty());
}

}  // namespace
}  // namespace roadstereo
