// Order statistics against ranks counted by hand, and the messages of require_range.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/order_statistics.hpp"
#include "core/require_range.hpp"

namespace roadstereo {
namespace {

const std::vector<double> four{7, 1, 5, 3};
const std::vector<double> five{9, 1, 7, 5, 3};

TEST(OrderStatistics, Medians) {
  EXPECT_EQ(upper_median(std::vector(four)), 5);
  EXPECT_EQ(central_median(std::vector(four)), 4);
  EXPECT_EQ(upper_median(std::vector(five)), 5);
  EXPECT_EQ(central_median(std::vector(five)), 5);
  EXPECT_EQ(upper_median_magnitude(std::vector<double>{-8, 1, 2, -4}), 4);
  EXPECT_EQ(upper_median_magnitude(std::vector<double>{}), 0);
}

// Sizes around the one from which values are counted first: of all magnitudes, in steps, all alike, and infinite.
TEST(OrderStatistics, MedianMagnitudesOfManyValues) {
  std::uint32_t state = 1;
  const auto next = [&state] { return static_cast<double>((state = state * 1664525U + 1013904223U) >> 8) * 0x1p-24; };
  for (const std::size_t size : {499U, 500U, 501U, 5000U}) {
    std::vector<std::vector<double>> all(5, std::vector<double>(size));
    for (std::size_t i = 0; i < size; ++i) {
      const double sign = next() < 0.5 ? -1 : 1;
      all[0][i] = sign * std::exp(20 * next() - 10);
      all[1][i] = sign * std::floor(6 * next());
      all[2][i] = sign * 0.3;
      all[3][i] = sign * (1 + 1e-9 * next());  // equal in single precision
      all[4][i] = next() < 0.6 ? sign * INFINITY : next();
    }
    for (const std::vector<double>& values : all) {
      std::vector<double> sorted(values), reordered(values);
      for (double& value : sorted) value = std::abs(value);
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(upper_median_magnitude(reordered), sorted[size / 2]) << size;
      EXPECT_TRUE(std::is_permutation(reordered.begin(), reordered.end(), values.begin()));
      if (size > 501) continue;
      std::vector<float> single(values.begin(), values.end());
      EXPECT_EQ(upper_median_magnitude(single), static_cast<double>(static_cast<float>(sorted[size / 2]))) << size;
    }
  }
}

TEST(OrderStatistics, QuantilesDifferInTheirRanks) {
  EXPECT_EQ(lower_quantile(std::vector(four), 0.6), 3);     // rank 1.8
  EXPECT_EQ(nearest_quantile(std::vector(four), 0.6), 5);   // rank 1.8
  EXPECT_EQ(covering_quantile(std::vector(four), 0.6), 5);  // 2.4 values
  EXPECT_EQ(covering_quantile(std::vector(four), 0.5), 3);  // 2 values
  EXPECT_EQ(covering_quantile(std::vector(four), 0.0), 1);
  for (const double share : {0.0, 1.0}) {
    EXPECT_EQ(lower_quantile(std::vector(five), share), share == 0 ? 1 : 9);
    EXPECT_EQ(nearest_quantile(std::vector(five), share), share == 0 ? 1 : 9);
  }
}

template <class Check>
std::string message(const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RequireRange, NamesTheOptionItsValueAndItsLimits) {
  EXPECT_EQ(message([] { require_range("a", "b", 3, 1, 3); }), "");
  EXPECT_EQ(message([] { require_range("a", "b", 4, 1, 3); }), "a.b is 4; it must be between 1 and 3");
  EXPECT_EQ(message([] { require_range("a", "b", -0.5, 0.0, unlimited); }), "a.b is -0.5; it must be at least 0");
  EXPECT_EQ(message([] { require_range("a", "b", 2.5, -unlimited, 2.0); }), "a.b is 2.5; it must be at most 2");
  EXPECT_EQ(message([] { require_range("a", "b", 0.0, Above{0.0}, 2.0); }),
            "a.b is 0; it must be above 0 and at most 2");
  EXPECT_EQ(message([] { require_range("a", "b", 0.0, Above{0.0}, unlimited); }), "a.b is 0; it must be above 0");
}

}  // namespace
}  // namespace roadstereo
