// Alignment of a pair along a plane: smooth texture in noise that hides it from single blocks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "road/plane_alignment.hpp"

namespace roadstereo {
namespace {

constexpr int width = 640, height = 240;

/// Waves of 25 to 60 pixels.
double texture(double u, double v) {
  return 300 * (std::sin(0.25 * u + 0.05 * v) + std::sin(0.12 * u - 0.2 * v + 1) + std::sin(-0.17 * u - 0.09 * v + 2));
}

struct Pair {
  GreyImage left{width, height}, right{width, height};

  /// The right image of points on the plane, with other light and noise of its own.
  Pair(const DisparityPlane& plane, double noise) {
    std::mt19937 random(7);
    std::normal_distribution<double> error(0, noise);
    const auto level = [&](double value) {
      return static_cast<std::int16_t>(std::clamp(std::lround(2000 + value + error(random)), 0L, 4080L));
    };
    for (int v = 0; v < height; ++v) {
      for (int x = 0; x < width; ++x) {
        left(x, v) = level(texture(x, v));
        const double u = (x + plane.a0 + plane.a1 * v) / (1 - plane.a2);
        right(x, v) = level(0.8 * texture(u, v) + 100);
      }
    }
  }
};

double largest_difference(const DisparityPlane& one, const DisparityPlane& other) {
  double most = 0;
  for (const double v : {0.0, height - 1.0}) {
    for (const double u : {0.0, width - 1.0}) {
      most = std::max(most, std::abs(one.disparity(u, v) - other.disparity(u, v)));
    }
  }
  return most;
}

constexpr DisparityPlane truth{20, 0.08, 0.01};

// Noise as large as a third of the texture's deviation of 367 leaves 1/1000 of a pixel with some 150 000 pixels; from
// the corners on the plane is three times less sure.
TEST(PlaneAlignment, FindsPlaneInNoise) {
  const Pair pair(truth, 120);
  const DisparityPlane start{21.5, 0.072, 0.0075};
  ASSERT_GT(largest_difference(start, truth), 1.4);
  for (const int threads : {1, 3}) {
    const DisparityPlane aligned = align_plane(pair.left, pair.right, {}, start, 2, true, threads);
    EXPECT_LT(largest_difference(aligned, truth), 0.05);
  }
  EXPECT_EQ(align_plane(pair.left, pair.right, {}, {21, 0.08, 0}, 2, false, 1).a2, 0) << "without roll";
}

// What is masked, here a strip of another plane, does not count.
TEST(PlaneAlignment, LeavesMaskedPixelsOut) {
  Pair pair(truth, 120);
  const Pair other({24, 0.08, 0.01}, 120);
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 60; v < height; ++v) {
    std::fill_n(mask.row(v), width, std::uint8_t{255});
    std::copy_n(other.right.row(v), width, pair.right.row(v));
  }
  const DisparityPlane start{20.6, 0.08, 0.01};
  const DisparityPlane aligned = align_plane(pair.left, pair.right, mask, start, 2, true, 1);
  EXPECT_NEAR(aligned.disparity(320, 30), truth.disparity(320, 30), 0.1);
}

TEST(PlaneAlignment, ReturnsPlaneWhereNothingCorrelates) {
  const Pair pair(truth, 0);
  const GreyImage black(width, height, 0);
  const DisparityPlane aligned = align_plane(pair.left, black, {}, truth, 2, true, 1);
  EXPECT_EQ(aligned.a0, truth.a0);
  EXPECT_EQ(aligned.a1, truth.a1);
  const GreyImage small(40, 32, 100);
  EXPECT_EQ(align_plane(small, small, {}, truth, 4, true, 1).a0, truth.a0) << "smaller than a block";
}

}  // namespace
}  // namespace roadstereo
