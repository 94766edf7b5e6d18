// Lucas–Kanade step: known disparities of painted pairs, and a normal equation solved pixel by pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "road/lucas_kanade/alignment_maps.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/lucas_kanade.hpp"
#include "roadstereo/perspective.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int width = 160, height = 60;

PerspectiveShift no_shift() {
  PerspectiveShift shift;
  shift.enabled = false;
  return shift;
}

Image<float> align(const test::TexturedPair& pair, const Image<float>& disparity,
                   const LucasKanadeOptions& options = {}, int threads = 1) {
  Image<float> aligned;
  lucas_kanade({pair.reference, pair.target, nullptr, no_shift()}, disparity, options, threads, aligned);
  return aligned;
}

/// Root mean square of map − truth away from the borders.
double rms_error(const Image<float>& map, double truth) {
  constexpr int border = 20;
  double sum = 0;
  int count = 0;
  for (int v = border; v < map.height() - border; ++v) {
    for (int u = border; u < map.width() - border; ++u) {
      sum += std::pow(static_cast<double>(map(u, v)) - truth, 2);
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

TEST(LucasKanade, UndoesPixelLocking) {
  for (const double truth : {6.1, 6.25, 6.4, 6.6, 6.75, 6.9}) {
    const test::TexturedPair pair = test::textured_pair(width, height, [&](double, double) { return truth; });
    const double locked = truth - 0.1 * std::sin(2 * std::numbers::pi * truth);
    const Image<float> disparity(width, height, static_cast<float>(locked));
    EXPECT_LT(rms_error(align(pair, disparity), truth), 0.02) << truth;
  }
}

/// A bright bar that never moves, masked: what its edges add to the filtered rows beside it is not used.
TEST(LucasKanade, LeavesOutWhatMaskTouches) {
  constexpr double truth = 6.3;
  constexpr int first = 70, last = 85;
  test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return truth; });
  Image<float> disparity(width, height, static_cast<float>(truth));
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 0; v < height; ++v) {
    for (int u = first; u <= last; ++u) {
      pair.reference(u, v) = pair.target(u, v) = static_cast<std::int16_t>(grey_max);
      mask(u, v) = 255;
      disparity(u, v) = nan;
    }
    for (int u = last + 1; u <= last + 8; ++u) {  // what the bar hides from the other camera
      mask(u, v) = 255;
      disparity(u, v) = nan;
    }
  }
  const auto error_beside = [&](ImageView<const std::uint8_t> used) {
    Image<float> aligned;
    TransformedPair masked{pair.reference, pair.target, nullptr, no_shift(), used};
    lucas_kanade(masked, disparity, {.bias_sigma_px = 0.04}, 1, aligned);
    double sum = 0;
    for (int v = 20; v < height - 20; ++v) {
      for (int u = first - 6; u < first; ++u) sum += std::pow(static_cast<double>(aligned(u, v)) - truth, 2);
    }
    return std::sqrt(sum / (6.0 * (height - 40)));
  };
  EXPECT_GT(error_beside({}), 0.04);
  EXPECT_LT(error_beside(mask), 0.02);
}

TEST(LucasKanade, IgnoresGainAndOffset) {
  constexpr double truth = 6.3;
  test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return truth; });
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      pair.target(u, v) = static_cast<std::int16_t>(std::lround(0.7 * pair.target(u, v) + 300));
    }
  }
  EXPECT_LT(rms_error(align(pair, Image<float>(width, height, 6.2F)), truth), 0.02);
}

TEST(LucasKanade, WorksThroughPerspectiveTransformation) {
  const DisparityPlane road{9.4, 0.11, 0.06};
  const test::TexturedPair pair =
      test::textured_pair(width, height, [&](double u, double v) { return road.disparity(u, v); });
  // The road is known only roughly: half a pixel beside the true one.
  const PerspectiveShift shift{{9.9, 0.11, 0.05}, 4, 12};
  GreyImage transformed;
  std::vector<int> first_column;
  transform_target(pair.target, shift, 1, transformed, first_column);
  Image<float> disparity(width, height), aligned;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) disparity(u, v) = static_cast<float>(road.disparity(u, v) + 0.1);
  }
  lucas_kanade({pair.reference, transformed, first_column.data(), shift}, disparity, {}, 1, aligned);
  for (int v = 15; v < height - 15; v += 5) {
    for (int u = 60; u < width - 20; u += 5) EXPECT_NEAR(aligned(u, v), road.disparity(u, v), 0.03) << u << ", " << v;
  }
}

TEST(LucasKanade, TrustsNoiseLittle) {
  test::TexturedPair pair{GreyImage(width, height), GreyImage(width, height)};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      pair.reference(u, v) = static_cast<std::int16_t>(grey_max * test::lattice(u, v, 1));
      pair.target(u, v) = static_cast<std::int16_t>(grey_max * test::lattice(u, v, 2));
    }
  }
  LucasKanadeOptions small, large;
  small.bias_sigma_px = 0.01;
  large.bias_sigma_px = 1;
  const Image<float> disparity(width, height, 5);
  const double changed = rms_error(align(pair, disparity, small), 5);
  EXPECT_LT(changed, 0.01);
  EXPECT_GT(rms_error(align(pair, disparity, large), 5), 5 * changed);
}

TEST(LucasKanade, LeavesPixelsWithoutTextureOrDisparity) {
  test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.3; });
  for (int v = 0; v < height; ++v) {
    for (int u = 90; u < width; ++u) pair.reference(u, v) = pair.target(u, v) = 1000;
  }
  Image<float> disparity(width, height, 6.2F);
  disparity(40, 30) = nan;
  const Image<float> aligned = align(pair, disparity);
  EXPECT_TRUE(std::isnan(aligned(40, 30)));
  EXPECT_NEAR(aligned(42, 30), 6.3, 0.02);
  EXPECT_EQ(aligned(120, 30), 6.2F);
}

// Textures whose deviation is less than that of rounding to 8 bits, 1/√12 of a grey level, and one of five times that.
TEST(LucasKanade, LeavesContrastBelowRounding) {
  const auto pair_of = [](double contrast) {
    return test::textured_pair(
        width, height, [](double, double) { return 6.3; }, 1, contrast);
  };
  const GreyImage full = pair_of(1).target;
  const double pixels = width * height;
  double sum = 0, squares = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      sum += full(u, v);
      squares += std::pow(static_cast<double>(full(u, v)), 2);
    }
  }
  const double rounding = grey_scale / std::sqrt(12.0);
  const double contrast = rounding / std::sqrt(squares / pixels - std::pow(sum / pixels, 2));
  const Image<float> disparity(width, height, 6.2F);
  EXPECT_EQ(rms_error(align(pair_of(0.5 * contrast), disparity), 6.2F), 0);
  EXPECT_LT(rms_error(align(pair_of(5 * contrast), disparity), 6.3), 0.03);
}

TEST(LucasKanade, ChangesByNoMoreThanLimit) {
  const test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.9; });
  LucasKanadeOptions options;
  options.bias_sigma_px = 10;
  options.max_shift_px = 0.05;
  const Image<float> aligned = align(pair, Image<float>(width, height, 6.5F), options);
  EXPECT_NEAR(aligned(80, 30), 6.55, 1e-5);
}

TEST(LucasKanade, RadiusZeroSwitchesStepOff) {
  const test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.9; });
  LucasKanadeOptions options;
  options.radius = 0;
  Image<float> disparity(width, height, 6.5F);
  disparity(3, 4) = 6.25F;
  EXPECT_EQ(align(pair, disparity, options), disparity);
}

TEST(LucasKanade, RejectsMaskOfOtherSize) {
  const test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.3; });
  const Image<std::uint8_t> mask(width, height - 1, 0);
  const Image<float> disparity(width, height, 6.3F);
  Image<float> aligned;
  for (const int radius : {0, 2}) {
    EXPECT_THROW(lucas_kanade({pair.reference, pair.target, nullptr, no_shift(), mask}, disparity, {.radius = radius},
                              1, aligned),
                 Error);
  }
}

double prefiltered_level(const GreyImage& image, int x, int y) {
  constexpr std::array<double, 5> weights{1, 2, 3, 2, 1};
  double sum = 0;
  for (int k = -2; k <= 2; ++k) sum += weights[static_cast<std::size_t>(k + 2)] * image(x + k, y);
  return sum;
}

/// Pearson's correlation over the window of a cell, at a whole disparity; both variances with that of a grey level.
double naive_correlation(const test::TexturedPair& pair, int disparity, int column, int line, int radius) {
  double n = 0, l = 0, t = 0, ll = 0, tt = 0, lt = 0;
  for (int y = std::max(0, 4 * (line - radius)); y < std::min(height, 4 * (line + radius + 1)); ++y) {
    for (int x = 4 * (column - radius); x < 4 * (column + radius + 1); ++x) {
      const double a = prefiltered_level(pair.reference, x, y), b = prefiltered_level(pair.target, x - disparity, y);
      n += 1;
      l += a;
      t += b;
      ll += a * a;
      tt += b * b;
      lt += a * b;
    }
  }
  constexpr double noise = 9.0 * 9 * grey_scale * grey_scale;
  return (lt / n - l / n * t / n) / std::sqrt((ll / n - l / n * l / n + noise) * (tt / n - t / n * t / n + noise));
}

TEST(LucasKanade, TellsCorrelationAlongDisparities) {
  const test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.0; });
  for (const int disparity : {6, 7, 11}) {
    Image<float> aligned, correlation;
    lucas_kanade({pair.reference, pair.target, nullptr, no_shift()},
                 Image<float>(width, height, static_cast<float>(disparity)), {}, 1, aligned, correlation);
    ASSERT_EQ(correlation.width(), width / 4);
    ASSERT_EQ(correlation.height(), height / 4);
    for (int j = 0; j < height / 4; j += 3) {
      for (int i = 10; i < width / 4 - 5; i += 4) {
        EXPECT_NEAR(correlation(i, j), naive_correlation(pair, disparity, i, j, 2), 2e-4) << i << ", " << j;
      }
    }
    if (disparity == 6) {
      EXPECT_GT(correlation(20, 7), 0.98);
    }
  }
}

/// −γ of L − T = α + β T + γ g by least squares over a window of the prefiltered rows, for gradients of equal contrast.
double naive_shift(const test::TexturedPair& pair, const Image<float>& disparity, int column, int line, int radius) {
  std::array<std::array<double, 4>, 3> normal{};
  double n = 0, l = 0, ll = 0, t1 = 0, t2 = 0;
  for (int y = std::max(0, 4 * (line - radius)); y < std::min(height, 4 * (line + radius + 1)); ++y) {
    for (int x = 4 * (column - radius); x < 4 * (column + radius + 1); ++x) {
      const double at = x - static_cast<double>(disparity(x, y));
      const int whole = static_cast<int>(std::floor(at));
      const double f = at - whole;
      std::array<double, 4> t{};
      for (int k = 0; k < 4; ++k) t[static_cast<std::size_t>(k)] = prefiltered_level(pair.target, whole - 1 + k, y);
      const double value = ((-0.5 * t[0] + 1.5 * t[1] - 1.5 * t[2] + 0.5 * t[3]) * f * f * f) +
                           ((t[0] - 2.5 * t[1] + 2 * t[2] - 0.5 * t[3]) * f * f) + (0.5 * (t[2] - t[0]) * f) + t[1];
      const double left =
          0.5 * (prefiltered_level(pair.reference, x + 1, y) - prefiltered_level(pair.reference, x - 1, y));
      const double right = 0.5 * ((1 - f) * (t[2] - t[0]) + f * (t[3] - t[1]));
      const double level = prefiltered_level(pair.reference, x, y);
      const std::array<double, 4> row{1, value / 1e4, 0.5 * (left + right), level - value};
      n += 1;
      l += level;
      ll += level * level;
      t1 += value;
      t2 += value * value;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 4; ++k) normal[i][k] += row[i] * row[k];
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {  // Gauss–Jordan; the matrix is positive definite
    for (std::size_t j = 0; j < 3; ++j) {
      if (j == i) continue;
      const double factor = normal[j][i] / normal[i][i];
      for (std::size_t k = 0; k < 4; ++k) normal[j][k] -= factor * normal[i][k];
    }
  }
  const double contrast = std::sqrt((ll - l * l / n) / (t2 - t1 * t1 / n));
  return -normal[2][3] / normal[2][2] * 0.5 * (contrast + 1) / contrast;
}

TEST(LucasKanade, SolvesNormalEquationOfEveryWindow) {
  const test::TexturedPair pair =
      test::textured_pair(width, height, [](double u, double v) { return 6 + std::sin(0.03 * u + 0.02 * v); });
  Image<float> disparity(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      disparity(u, v) =
          static_cast<float>(6 + std::sin(0.03 * u + 0.02 * v) + 0.2 * (test::smooth_noise(u, v, 9, 4) - 0.5));
    }
  }
  LucasKanadeOptions options;
  options.bias_sigma_px = 10;  // the variance has no part in it
  for (const int radius : {1, 2, 5}) {
    options.radius = radius;
    const Image<float> aligned = align(pair, disparity, options);
    const auto shift = [&](int i, int j) { return std::clamp(naive_shift(pair, disparity, i, j, radius), -0.5, 0.5); };
    for (int v = 2; v < height - 2; v += 7) {
      for (int u = 42; u < width - 40; u += 9) {
        const int i = (u - 2) / 4, j = (v - 2) / 4;  // the middle of cell i is at 4 i + 1.5
        const double x = (u - 1.5) / 4 - i, y = (v - 1.5) / 4 - j;
        const double expected = (1 - y) * ((1 - x) * shift(i, j) + x * shift(i + 1, j)) +
                                y * ((1 - x) * shift(i, j + 1) + x * shift(i + 1, j + 1));
        ASSERT_NEAR(aligned(u, v) - disparity(u, v), expected, 3e-4) << radius << ": " << u << ", " << v;
      }
    }
  }
}

TEST(LucasKanade, IsIndependentOfThreads) {
  const test::TexturedPair pair = test::textured_pair(width, height, [](double, double) { return 6.3; });
  Image<float> disparity(width, height, 6.2F);
  disparity(70, 33) = nan;
  const Image<float> one = align(pair, disparity);
  for (const int threads : {2, 3, 7}) {
    const Image<float> several = align(pair, disparity, {}, threads);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (std::isnan(one(u, v))) continue;
        ASSERT_EQ(several(u, v), one(u, v)) << u << ", " << v;
      }
    }
  }
}

TEST(LucasKanade, TakesImagesSmallerThanWindow) {
  for (const int size : {1, 3, 6, 8}) {
    const test::TexturedPair pair = test::textured_pair(size, size, [](double, double) { return 0.5; });
    EXPECT_EQ(align(pair, Image<float>(size, size, 0.5F)).width(), size);
  }
}

TEST(LucasKanade, RejectsBadInput) {
  const test::TexturedPair pair = test::textured_pair(20, 20, [](double, double) { return 3.0; });
  EXPECT_THROW(align(pair, Image<float>(20, 19, 3.0F)), Error);
  LucasKanadeOptions options;
  options.radius = 9;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.bias_sigma_px = 0;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.max_shift_px = 3;
  EXPECT_THROW(options.validate(), Error);
}

}  // namespace
}  // namespace roadstereo
