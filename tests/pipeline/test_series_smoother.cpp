// Smoothed series against least squares, and against the truth of simulated ones.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadstereo/series_smoother.hpp"

namespace roadstereo {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A swing of 3 in 60 samples, measured with normal noise.
struct Swing {
  std::vector<SeriesSample> samples;
  std::vector<double> truth;

  explicit Swing(double noise, int count = 400, double step = 1.0 / 30) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, noise);
    for (int k = 0; k < count; ++k) {
      truth.push_back(3 * std::sin(k / 60.0 * 6.2831853));
      samples.push_back({k * step, truth.back() + normal(random), unknown});
    }
  }
};

struct Score {
  double rms = 0, within_two = 0;
};

Score score(const std::vector<Measurement>& smoothed, const std::vector<double>& truth) {
  Score score;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const double error = smoothed[k].value - truth[k];
    score.rms += error * error;
    score.within_two += std::abs(error) <= 2 * smoothed[k].std_error ? 1 : 0;
  }
  const auto n = static_cast<double>(truth.size());
  return {std::sqrt(score.rms / n), score.within_two / n};
}

/// Without acceleration the smoother is the least-squares line. Its variance in the middle is that of a mean.
TEST(SmoothSeries, OfStraightLineIsLeastSquares) {
  constexpr int count = 301;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.5);
  std::vector<SeriesSample> samples;
  double st = 0, sy = 0, stt = 0, sty = 0;
  for (int k = 0; k < count; ++k) {
    const double time = k - 150, value = 2 + 0.01 * time + normal(random);
    samples.push_back({time, value, unknown});
    st += time;
    sy += value;
    stt += time * time;
    sty += time * value;
  }
  const std::vector<Measurement> smoothed = smooth_series(samples);
  const double slope = (count * sty - st * sy) / (count * stt - st * st), middle = sy / count;
  for (const int k : {0, 75, 150, 300}) {
    EXPECT_NEAR(smoothed[static_cast<std::size_t>(k)].value, middle + slope * (k - 150), 0.02) << k;
  }
  EXPECT_NEAR(smoothed[150].std_error, 0.5 / std::sqrt(count), 0.1 * 0.5 / std::sqrt(count));
}

TEST(SmoothSeries, IsNearerToTruthThanSamplesAndKnowsBy) {
  for (const double noise : {0.05, 0.3, 1.0}) {
    const Swing swing(noise);
    const Score result = score(smooth_series(swing.samples), swing.truth);
    EXPECT_LT(result.rms, 0.6 * noise) << noise;
    EXPECT_GE(result.within_two, 0.9) << noise;
  }
}

/// Errors that all samples share: the standard error stays what it was given as.
TEST(SmoothSeries, KeepsErrorCommonToAllSamples) {
  Swing swing(0.1);
  for (SeriesSample& sample : swing.samples) {
    sample.value += 1;
    sample.std_error = 1;
  }
  const std::vector<Measurement> smoothed = smooth_series(swing.samples);
  for (const Measurement& value : smoothed) EXPECT_NEAR(value.std_error, 1, 0.02);
  EXPECT_EQ(score(smoothed, swing.truth).within_two, 1);
}

/// Given errors weigh the samples: every third is ten times as noisy.
TEST(SmoothSeries, WeighsSamplesByTheirErrors) {
  Swing weighted(0.1);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t k = 0; k < weighted.samples.size(); ++k) {
    weighted.samples[k].std_error = k % 3 == 0 ? 1 : 0.1;
    if (k % 3 == 0) weighted.samples[k].value += normal(random);
  }
  std::vector<SeriesSample> equal = weighted.samples;
  for (SeriesSample& sample : equal) sample.std_error = unknown;
  EXPECT_LT(score(smooth_series(weighted.samples), weighted.truth).rms, 0.1);
  EXPECT_GT(score(smooth_series(equal), weighted.truth).rms, 0.1);
}

/// An error of 0 is none: it must not discard those of the others.
TEST(SmoothSeries, OneSampleWithoutErrorTakesThatOfTheOthers) {
  Swing swing(0.1);
  for (SeriesSample& sample : swing.samples) sample.std_error = 1;
  swing.samples[7].std_error = 0;
  for (const Measurement& value : smooth_series(swing.samples)) EXPECT_NEAR(value.std_error, 1, 0.02);
}

TEST(SmoothSeries, UnitsHaveNoEffect) {
  const Swing swing(0.2, 100);
  std::vector<SeriesSample> scaled = swing.samples;
  for (SeriesSample& sample : scaled) {
    sample.time *= 1000;
    sample.value *= 1e-3;
  }
  const std::vector<Measurement> one = smooth_series(swing.samples), other = smooth_series(scaled);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_NEAR(1000 * other[k].value, one[k].value, 1e-6);
    EXPECT_NEAR(1000 * other[k].std_error, one[k].std_error, 1e-6);
  }
}

/// Over a gap of 50 of 60 samples nothing carries over, and the samples on both sides keep their accuracy.
TEST(SmoothSeries, GapsStayGaps) {
  Swing swing(0.1);
  for (std::size_t k = 100; k < 150; ++k) swing.samples[k].value = unknown;
  const std::vector<Measurement> smoothed = smooth_series(swing.samples);
  EXPECT_TRUE(std::isnan(smoothed[120].value));
  EXPECT_NEAR(smoothed[99].value, swing.truth[99], 4 * smoothed[99].std_error);
  EXPECT_NEAR(smoothed[150].value, swing.truth[150], 4 * smoothed[150].std_error);
  EXPECT_GT(smoothed[150].std_error, smoothed[250].std_error);
}

TEST(SmoothSeries, TakesWhatMayCome) {
  EXPECT_TRUE(smooth_series({}).empty());
  const std::vector<SeriesSample> few{{0, 1, 0.5}, {1, unknown, unknown}, {2, 3, 0.5}};
  const std::vector<Measurement> kept = smooth_series(few);
  EXPECT_EQ(kept[2].value, 3);
  EXPECT_EQ(kept[2].std_error, 0.5);
  const std::vector<SeriesSample> same(8, {1, 4, unknown});  // one time, one value
  for (const Measurement& value : smooth_series(same)) {
    EXPECT_NEAR(value.value, 4, 1e-9);
    EXPECT_LT(value.std_error, 1e-6);
  }
}

}  // namespace
}  // namespace roadstereo
