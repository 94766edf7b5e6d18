// The roads of `evaluate subpixel`, against sampling theory: their waves are longer than 4 pixels, so that
// interpolation by a windowed sinc is exact to a fraction of a grey level.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluate/wave_road.hpp"
#include "tests/cli/command_test.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::cli;

constexpr int taps = 16;

double windowed_sinc(double x) {
  if (x == 0) return 1;
  if (std::abs(x) >= taps) return 0;
  const double a = std::numbers::pi * x, b = a / taps;
  return std::sin(a) / a * std::sin(b) / b;
}

/// Grey level at column x of a row.
double sample(const Frame& frame, double x, int v) {
  const int centre = static_cast<int>(std::floor(x));
  double sum = 0;
  for (int u = centre - taps + 1; u <= centre + taps; ++u) {
    const auto at = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(u);
    sum += frame.bytes[at] * windowed_sinc(x - u);
  }
  return sum;
}

const WaveRoad& example_road() {
  static const WaveRoad road(3, 2);
  return road;
}

TEST(WaveRoad, BothPicturesShowTheRoadAtItsDisparities) {
  const WaveRoad& road = example_road();
  const StereoPair pair = road.shot(0, 1);
  double squares = 0, derivative_squares = 0, largest_phase = 0, smallest_phase = 1;
  int pixels = 0;
  for (int v = 60; v < WaveRoad::height; v += 40) {
    for (int u = 90; u < WaveRoad::width - 40; u += 7) {
      const double d = road.truth()(u, v);
      const double error = sample(pair.right, u - d, v) - sample(pair.left, u, v);
      const double derivative = (sample(pair.left, u + 0.05, v) - sample(pair.left, u - 0.05, v)) / 0.1;
      squares += error * error;
      derivative_squares += std::pow(derivative - road.derivative()(u, v), 2);
      largest_phase = std::max(largest_phase, d - std::floor(d));
      smallest_phase = std::min(smallest_phase, d - std::floor(d));
      ++pixels;
    }
  }
  // Rounding to 8 bits: √(2/12) of the difference; of the derivative √(π²/3 / 12).
  EXPECT_NEAR(std::sqrt(squares / pixels), std::sqrt(2.0 / 12), 0.06);
  EXPECT_NEAR(std::sqrt(derivative_squares / pixels), std::numbers::pi / 6, 0.08);
  EXPECT_LT(smallest_phase, 0.05);
  EXPECT_GT(largest_phase, 0.95);
}

TEST(WaveRoad, ShotsDifferInNoiseAlone) {
  const WaveRoad& road = example_road();
  const StereoPair one = road.shot(4, 1), other = road.shot(4, 2), again = road.shot(4, 1);
  EXPECT_EQ(one.left.bytes, again.left.bytes);
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < one.left.bytes.size(); ++i) {
    const double difference = one.left.bytes[i] - other.left.bytes[i];
    squares += difference * difference;
    sum += difference;
  }
  const auto pixels = static_cast<double>(one.left.bytes.size());
  EXPECT_NEAR(sum / pixels, 0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / pixels), std::sqrt(2 * (16 + 1.0 / 12)), 0.05);
}

class SubPixelCommand : public CommandTest {};

TEST_F(SubPixelCommand, ComparesEveryMethodWithTheBound) {
  const Outcome outcome = run("evaluate subpixel --roads 1 --json subpixel.json --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("goals of default"), std::string::npos) << outcome.out;
  const auto document = json_file("subpixel.json");
  ASSERT_EQ(document["methods"].size(), 3U * 7U);
  ASSERT_EQ(document["phases"].size(), 3U * 7U);
  for (const auto& row : document["methods"]) {
    const std::string method = row["method"];
    EXPECT_GT(row["ratio"], 0.9) << row;  // nobody is better than the bound
    if (method == "default") {
      EXPECT_LT(row["max_bias_px"], 0.02) << row;
      EXPECT_LT(row["ratio"], 1.6) << row;
    }
    if (method == "SGBM") {  // it locks to whole pixels: Szeliski and Scharstein 2004
      EXPECT_GT(row["ripple_px"], 0.1) << row;
    }
  }
}

}  // namespace
