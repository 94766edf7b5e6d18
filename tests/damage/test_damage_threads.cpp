// Damage is the same, bit for bit, whatever the number of threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

TEST(FindDamage, IsIndependentOfThreads) {
  const DamageMap one = find_damage(damaged().metric(), {}, 1);
  for (const int threads : {2, 3, 7, 0}) expect_same(one, find_damage(damaged().metric(), {}, threads));
}

/// Depth of a round hollow with a flat floor, pixels.
double hollow(double from_u, double from_v, double radius_px, double depth_px) {
  return depth_px * std::clamp((radius_px - std::hypot(from_u, from_v)) / (0.3 * radius_px), 0.0, 1.0);
}

/// Depth, in pixels of disparity, of two potholes that touch, of a rut down the picture, and of hollows and bumps all
/// over the rest of it.
double crowded_depth(int u, int v) {
  const double rut = std::max(0.0, 1 - std::pow((u - 540) / 50.0, 2));
  double depth = hollow(u - 200, v - 170, 50, 4) + hollow(u - 290, v - 170, 46, 2.5) + rut;
  const int column = u / 60, row = v / 60;
  const bool is_taken = (column >= 2 && column <= 5 && row >= 1 && row <= 3) || column >= 8;
  if (!is_taken) {
    const double small = (row + column) % 3 == 0 ? -0.6 : 0.6;
    depth += hollow(u - 60 * column - 30, v - 60 * row - 30, 14 + row, small + 0.1 * small * column);
  }
  return depth;
}

// Every region is a damage, or a candidate: a difference in the order of sums, of merges or of lists shows.
TEST(FindDamage, CrowdedMapIsIndependentOfThreads) {
  constexpr int width = 640, height = 360;
  const DisparityPlane& plane = damaged().pair.plane;
  Image<float> exact(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) exact(u, v) = static_cast<float>(plane.disparity(u, v) - crowded_depth(u, v));
  }
  const auto pictures = test::textured_pair(width, height, [&exact](double u, double v) {
    return double{exact(std::clamp(static_cast<int>(std::lround(u)), 0, exact.width() - 1), static_cast<int>(v))};
  });
  Image<float> disparity = with_noise(exact, 0.03);
  for (int v = 100; v < 130; ++v) std::fill_n(disparity.row(v) + 330, 60, truth::nan_value);
  const Image<float> transformed = transformed_by(plane, disparity), sigma(width, height, 0.03F);
  DamageInput input = damaged().metric();
  input.disparity = disparity;
  input.transformed = transformed;
  input.sigma = sigma;
  input.grey = pictures.reference;
  input.right = pictures.target;
  DamageOptions options;
  options.threshold_sigma = 2;
  options.min_confidence = 0;
  const DamageMap one = find_damage(input, options, 1);
  EXPECT_GE(one.damages.size(), 3U);
  EXPECT_GE(one.damages.size() + one.candidates.size(), 20U) << one.damages.size();
  for (const int threads : {2, 3, 7}) {
    SCOPED_TRACE(threads);
    expect_same(one, find_damage(input, options, threads));
  }
}

}  // namespace
}  // namespace roadstereo
