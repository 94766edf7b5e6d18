#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "evaluation/disparity_score.hpp"
#include "roadstereo/error.hpp"

namespace {

using namespace roadstereo;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Six pixels: errors −1, 0, 2 and 3 px, one disparity missing, one truth unlabelled.
struct Example {
  Image<float> map{3, 2};
  Image<float> truth{3, 2};
  Example() {
    const float given[] = {9, 10, 12, 13, none, 50};
    const float real[] = {10, 10, 10, 10, 10, none};
    for (int i = 0; i < 6; ++i) {
      map(i % 3, i / 3) = given[i];
      truth(i % 3, i / 3) = real[i];
    }
  }
};

TEST(DisparityScore, MatchesExampleByHand) {
  const Example example;
  const std::array tolerances{0.5, 2.0, 3.0};
  const DisparityScore score = score_disparity(example.map, example.truth, std::nullopt, tolerances);
  EXPECT_EQ(score.labelled_pixels, 5U);
  EXPECT_EQ(score.valid_pixels, 4U);
  EXPECT_DOUBLE_EQ(score.density, 0.8);
  EXPECT_DOUBLE_EQ(score.rms_px, std::sqrt(14.0 / 4));
  EXPECT_DOUBLE_EQ(score.mean_px, 1.0);
  EXPECT_DOUBLE_EQ(score.sd_px, std::sqrt(10.0 / 4));
  EXPECT_DOUBLE_EQ(score.median_px, 1.5);
  // An error of exactly the tolerance is none (eq. (35)).
  EXPECT_EQ(score.bad_share, (std::vector{0.75, 0.25, 0.0}));
  EXPECT_EQ(score.bad_or_missing_share, (std::vector{0.8, 0.4, 0.2}));
}

TEST(DisparityScore, IgnoresMaskedPixels) {
  const Example example;
  Image<std::uint8_t> mask(3, 2, 0);
  mask(0, 0) = 255;  // error −1
  mask(2, 0) = 1;    // error 2
  mask(0, 1) = 255;  // error 3
  const std::array tolerances{1.0};
  const DisparityScore score =
      score_disparity(example.map, example.truth, ImageView<const std::uint8_t>(mask), tolerances);
  EXPECT_EQ(score.labelled_pixels, 3U);
  EXPECT_DOUBLE_EQ(score.mean_px, 4.0 / 3);
  EXPECT_DOUBLE_EQ(score.median_px, 2.0);
  EXPECT_DOUBLE_EQ(score.bad_share[0], 2.0 / 3);
}

TEST(DisparityScore, EmptyMapHasNoErrorButIsMissing) {
  const Image<float> map(4, 4, none);
  const Image<float> truth(4, 4, 7.0F);
  const std::array tolerances{1.0};
  const DisparityScore score = score_disparity(map, truth, std::nullopt, tolerances);
  EXPECT_TRUE(std::isnan(score.rms_px));
  EXPECT_TRUE(std::isnan(score.median_px));
  EXPECT_TRUE(std::isnan(score.bad_share[0]));
  EXPECT_DOUBLE_EQ(score.bad_or_missing_share[0], 1.0);
  EXPECT_DOUBLE_EQ(score.density, 0.0);
}

TEST(DisparityScore, EmptyTruthHasNoFigures) {
  const Image<float> map(4, 4, 3.0F);
  const Image<float> truth(4, 4, none);
  const std::array tolerances{1.0};
  const DisparityScore score = score_disparity(map, truth, std::nullopt, tolerances);
  EXPECT_EQ(score.labelled_pixels, 0U);
  EXPECT_DOUBLE_EQ(score.density, 0.0);
  EXPECT_TRUE(std::isnan(score.bad_or_missing_share[0]));
}

std::string complaint(const Image<float>& map, const Image<float>& truth, double tolerance) {
  try {
    const std::array tolerances{tolerance};
    score_disparity(map, truth, std::nullopt, tolerances);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DisparityScore, RejectsBadInput) {
  const Image<float> small(3, 2, 1.0F);
  const Image<float> large(4, 2, 1.0F);
  EXPECT_NE(complaint(small, large, 1).find("4×2"), std::string::npos);
  EXPECT_NE(complaint(small, small, -1).find("-1 px"), std::string::npos);
  EXPECT_EQ(complaint(small, small, 0), "");
}

}  // namespace
