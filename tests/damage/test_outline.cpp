#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "damage/outline.hpp"

namespace roadstereo {
namespace {

TEST(Octants, FollowOneAnotherAroundMiddle) {
  const Octants octants({40, 40, 60, 60});
  for (std::size_t k = 0; k < Octants::count; ++k) {
    const double angle = (static_cast<double>(k) + 0.5) * std::numbers::pi / 4;
    const auto at = [angle](double radius, double (*of)(double)) {
      return 50 + static_cast<int>(std::lround(radius * of(angle)));
    };
    EXPECT_EQ(octants.of(at(30, std::cos), at(30, std::sin)), k);
  }
}

/// A wide box has wide octants: its corners end them.
TEST(Octants, HaveProportionsOfBox) {
  const Octants octants({0, 0, 80, 8});
  EXPECT_NE(octants.of(76, 8), octants.of(84, 8));
  EXPECT_EQ(octants.of(76, 9), octants.of(50, 9));
}

/// To the left of a region is a smooth road at 0.2, to its right a rough verge: ±1 in turn.
TEST(BandAround, HalvesTellRoadFromVerge) {
  Image<float> depth(100, 100, 0.2F);
  for (int j = 0; j < 100; ++j) {
    for (int i = 51; i < 100; ++i) depth(i, j) = (i + j) % 2 == 0 ? 1.0F : -1.0F;
  }
  Image<std::uint8_t> allowed(100, 100, 255), visited(100, 100, 0);
  BoxMask region({40, 40, 60, 60});
  for (int j = 40; j <= 60; ++j) {
    for (int i = 40; i <= 60; ++i) region.set(i, j);
  }
  const BandAround band = band_around({depth, allowed, visited}, region, 3, 1);
  std::size_t samples = 0;
  double least = 1e9, largest = 0;
  for (const RobustNormal& half : band.halves) {
    samples += half.samples;
    least = std::min(least, half.sigma);
    largest = std::max(largest, half.sigma);
  }
  EXPECT_EQ(samples, 4 * band.whole.samples) << "each octant is in four";
  EXPECT_NEAR(band.halves[2].median, 0.2, 1e-6) << "to the left";
  EXPECT_EQ(least, 0);
  EXPECT_GE(largest, 1) << "half of a verge";
  EXPECT_LT(band.whole.sigma, largest);
  EXPECT_EQ(depths_around({depth, allowed, visited}, region, 3, 1).sigma, band.whole.sigma);
}

}  // namespace
}  // namespace roadstereo
