// Noise against its bound, on errors whose figures are known in closed form: those of least squares on a constant
// gradient g in noise n, √2·n/g a pixel, averaged over a box of w×w pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evaluation/sub_pixel_noise.hpp"
#include "roadstereo/error.hpp"
#include "synth/hash.hpp"

namespace {

using namespace roadstereo;

constexpr int width = 400, height = 300, window = 9;
constexpr double noise_grey = 2, gradient = 5;

/// Map of the disparity 10 px with errors of `scale` times those of least squares.
Image<float> box_averaged(std::uint64_t seed, double scale) {
  constexpr int radius = window / 2;
  Image<double> white(width + window, height + window);
  for (int v = 0; v < white.height(); ++v) {
    for (int u = 0; u < white.width(); ++u) {
      white(u, v) = synth::normal_value(synth::mix64(seed) + static_cast<std::uint64_t>(v * white.width() + u));
    }
  }
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double sum = 0;
      for (int y = 0; y <= 2 * radius; ++y) {
        for (int x = 0; x <= 2 * radius; ++x) sum += white(u + x, v + y);
      }
      map(u, v) = static_cast<float>(10 + scale * std::sqrt(2.0) * noise_grey / gradient * sum / (window * window));
    }
  }
  return map;
}

struct Shots {
  Image<float> first = box_averaged(1, 1), second = box_averaged(2, 1);
  Image<float> derivative{width, height, static_cast<float>(gradient)};
  Image<std::uint8_t> mask{width, height, 255};
};

TEST(SubPixelNoise, LeastSquaresOverABoxReachesTheBound) {
  const Shots shots;
  SubPixelNoise noise;
  noise.add(shots.first, shots.second, shots.derivative, shots.mask, noise_grey);
  const double expected = std::sqrt(2.0) * noise_grey / (gradient * window);
  EXPECT_NEAR(noise.noise_px(), expected, 0.05 * expected);
  EXPECT_NEAR(noise.support_px(), window, 0.1 * window);
  EXPECT_NEAR(noise.ratio(), 1, 0.1);
  EXPECT_DOUBLE_EQ(noise.bound_px(), noise.noise_px() / noise.ratio());
}

TEST(SubPixelNoise, BiasDoesNotCountAndNoiseBeyondTheBoundDoes) {
  Shots shots;
  shots.first = box_averaged(1, 2);
  shots.second = box_averaged(2, 2);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const float bias = 0.3F * std::sin(0.05F * static_cast<float>(u));
      shots.first(u, v) += bias;
      shots.second(u, v) += bias;
    }
  }
  SubPixelNoise noise;
  noise.add(shots.first, shots.second, shots.derivative, shots.mask, noise_grey);
  EXPECT_NEAR(noise.ratio(), 2, 0.2);
}

TEST(SubPixelNoise, MismatchesMissingAndMaskedPixelsAreLeftOut) {
  Shots shots;
  SubPixelNoise whole;
  whole.add(shots.first, shots.second, shots.derivative, shots.mask, noise_grey);
  for (int v = 0; v < height; ++v) {
    shots.first(100, v) = std::numeric_limits<float>::quiet_NaN();
    shots.second(200, v) += 3;
    for (int u = 250; u < width; ++u) {
      shots.mask(u, v) = 0;
      shots.derivative(u, v) = 1000;
    }
  }
  SubPixelNoise noise;
  noise.add(shots.first, shots.second, shots.derivative, shots.mask, noise_grey);
  EXPECT_NEAR(noise.noise_px(), whole.noise_px(), 0.05 * whole.noise_px());
  EXPECT_NEAR(noise.ratio(), whole.ratio(), 0.1);
}

TEST(SubPixelNoise, EmptyIsNanAndSizesMustAgree) {
  SubPixelNoise noise;
  EXPECT_TRUE(std::isnan(noise.noise_px()));
  EXPECT_TRUE(std::isnan(noise.ratio()));
  const Shots shots;
  try {
    noise.add(shots.first, shots.second, Image<float>(3, 2), shots.mask, 1);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the first map has 400×300 pixels and the derivative 3×2; they must have the same size");
  }
}

}  // namespace
