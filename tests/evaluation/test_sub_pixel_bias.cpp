#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evaluation/sub_pixel_bias.hpp"
#include "roadstereo/error.hpp"

namespace {

using namespace roadstereo;

/// Truth 10.0, 10.01 … 19.99, and a matcher that rounds to whole disparities.
struct Rounding {
  Image<float> map{1000, 1};
  Image<float> truth{1000, 1};
  Image<std::uint8_t> mask{1000, 1, 255};
  Rounding() {
    for (int u = 0; u < 1000; ++u) {
      truth(u, 0) = 10.005F + 0.01F * static_cast<float>(u);
      map(u, 0) = std::round(truth(u, 0));
    }
  }
};

TEST(SubPixelBias, RoundingGivesSawtooth) {
  const Rounding pair;
  SubPixelBias bias(4);
  bias.add(pair.map, pair.truth, pair.mask);
  EXPECT_EQ(bias.phases(), (std::vector{0.125, 0.375, 0.625, 0.875}));
  // Phases 0 … 0.25 are rounded down by their mean, 0.125, and so on.
  const std::vector<double> means = bias.means_px();
  EXPECT_NEAR(means[0], -0.125, 1e-4);
  EXPECT_NEAR(means[1], -0.375, 1e-4);
  EXPECT_NEAR(means[2], 0.375, 1e-4);
  EXPECT_NEAR(means[3], 0.125, 1e-4);
  EXPECT_NEAR(bias.ripple_px(), 0.75, 1e-4);
}

TEST(SubPixelBias, IgnoresGrossMissingAndMasked) {
  Rounding pair;
  for (int u = 0; u < 1000; ++u) pair.map(u, 0) = pair.truth(u, 0) + 0.5F;
  pair.map(100, 0) += 5;
  pair.map(200, 0) = std::numeric_limits<float>::quiet_NaN();
  pair.map(300, 0) = pair.truth(300, 0);
  pair.mask(300, 0) = 0;
  SubPixelBias bias;
  bias.add(pair.map, pair.truth, pair.mask);
  for (const double mean : bias.means_px()) EXPECT_NEAR(mean, 0.5, 1e-5);
}

TEST(SubPixelBias, EmptyMapIsNan) {
  EXPECT_TRUE(std::isnan(SubPixelBias().ripple_px()));
  EXPECT_THROW(SubPixelBias(1), Error);
  SubPixelBias bias;
  try {
    bias.add(Image<float>(3, 2), Image<float>(3, 2), Image<std::uint8_t>(2, 2));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the ground truth has 3×2 pixels and the mask 2×2; they must have the same size");
  }
}

}  // namespace
