// The line of the rows' offsets from samples with known errors.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "road/row_offset_fit.hpp"

namespace roadstereo {
namespace {

/// Samples of a grid of 15×9 with the offset `line` at their columns in the right image, and normal noise.
std::vector<RowSample> samples_of(const RowOffset& line, double noise) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  std::vector<RowSample> samples;
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 15; ++i) {
      const double u = 20 + 40 * i, v = 20 + 40 * j, du = -5 - 3 * j;
      samples.push_back({u, v, du, line.at(u + du, v) + noise * normal(random)});
    }
  }
  return samples;
}

TEST(FitRowOffset, FindsLineAmongOutliers) {
  const RowOffset line{-0.3, 7e-4, -2e-4};
  std::vector<RowSample> samples = samples_of(line, 0.02);
  for (std::size_t k = 0; k < samples.size(); k += 5) samples[k].dv = k % 2 == 0 ? 3 : -2;
  const RowOffset fit = fit_row_offset(samples);
  // σ/√n of 108 points over 560 columns and 320 rows, four times.
  EXPECT_NEAR(fit.at(280, 180), line.at(280, 180), 0.008);
  EXPECT_NEAR(fit.per_column, line.per_column, 5e-5);
  EXPECT_NEAR(fit.per_row, line.per_row, 8e-5);
}

TEST(FitRowOffset, LeavesOutWhatIsNotSignificant) {
  const RowOffset shifted = fit_row_offset(samples_of({0.2, 0, 0}, 0.05));
  EXPECT_NEAR(shifted.constant_px, 0.2, 0.02);
  EXPECT_EQ(shifted.per_column, 0);
  EXPECT_EQ(shifted.per_row, 0);
  EXPECT_EQ(fit_row_offset(samples_of({}, 0.05)).constant_px, 0);
}

}  // namespace
}  // namespace roadstereo
