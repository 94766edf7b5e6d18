// Standard errors against errors, on samples whose figures are known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evaluate/sigma_calibration.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::cli;

TEST(SigmaCalibration, MatchesSharesAndMediansByHand) {
  // In units of σ: 0.5, 1 (not smaller than σ), 1.5, 3.
  const SigmaCalibration calibration = calibrate_sigma({{0.5F, 1}, {2, 2}, {6, 4}, {24, 8}});
  EXPECT_EQ(calibration.pixels, 4U);
  EXPECT_DOUBLE_EQ(calibration.within_1, 0.25);
  EXPECT_DOUBLE_EQ(calibration.within_2, 0.75);
  EXPECT_DOUBLE_EQ(calibration.median_error_px, 4);
  EXPECT_DOUBLE_EQ(calibration.median_sigma_px, 3);
}

TEST(SigmaCalibration, SortsBinsByStandardError) {
  const std::vector<SigmaBin> bins = sigma_bins({{9, 4}, {3, 1}, {5, 3}, {4, 2}, {12, 4}}, 2);
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_EQ(bins[0].pixels, 2U);
  EXPECT_EQ(bins[1].pixels, 3U);
  EXPECT_DOUBLE_EQ(bins[0].sigma_px, 1.5);
  EXPECT_DOUBLE_EQ(bins[0].rms_px, std::sqrt((9.0 + 16.0) / 2));
  EXPECT_DOUBLE_EQ(bins[1].sigma_px, 4);
  EXPECT_DOUBLE_EQ(bins[1].p68_px, 9);  // the second of 5, 9, 12
  EXPECT_DOUBLE_EQ(bins[1].within_2, 1.0 / 3);
  EXPECT_EQ(sigma_bins({{1, 1}}, 10).size(), 1U);
}

TEST(SigmaCalibration, UsesValidMaskedPixelsOnly) {
  Image<float> disparity(4, 1, 10.0F), truth(4, 1, 10.5F);
  const Image<float> sigma(4, 1, 0.25F);
  Image<std::uint8_t> mask(4, 1, 255);
  disparity(0, 0) = std::numeric_limits<float>::quiet_NaN();
  truth(1, 0) = std::numeric_limits<float>::quiet_NaN();
  mask(2, 0) = 0;
  std::vector<SigmaSample> claims;
  add_sigma_samples(disparity, sigma, truth, mask, claims);
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].error_px, 0.5F);
  EXPECT_EQ(claims[0].sigma_px, 0.25F);
}

}  // namespace
