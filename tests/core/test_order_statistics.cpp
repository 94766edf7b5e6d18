// Order statistics against ranks counted by hand, and the messages of require_range.

#include <gtest/gtest.h>

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
