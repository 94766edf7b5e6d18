#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "io/flight/place_index.hpp"

namespace roadstereo::io {
namespace {

struct Ball {
  std::int64_t id = 0;
  int piece = 0;
  std::array<double, 3> centre_m{};
  double radius_m = 0;
};

bool touch(const Ball& one, const Ball& other) {
  const auto &a = one.centre_m, &b = other.centre_m;
  return one.piece == other.piece && std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= one.radius_m + other.radius_m;
}

/// Brute force: ids of the balls that touch one, in ascending order.
std::vector<std::int64_t> touching(const Ball& one, const std::vector<Ball>& all) {
  std::vector<std::int64_t> ids;
  for (const Ball& other : all) {
    if (touch(one, other)) ids.push_back(other.id);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

TEST(PlaceIndex, FindsAllThatBruteForceFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-100, 100), across(-3, 3), log_radius(-3, 3.5);
  std::vector<Ball> balls;
  PlaceIndex index;
  for (int i = 0; i < 2000; ++i) {
    Ball ball{static_cast<std::int64_t>(random() % 800) + 1, static_cast<int>(random() % 2), {}, 0};
    ball.centre_m = {along(random), across(random), along(random)};
    ball.radius_m = i % 200 == 0 ? 50 : std::exp(log_radius(random));
    if (i % 2 == 0) {
      index.add(ball.id, ball.piece, ball.centre_m, ball.radius_m);
      balls.push_back(ball);
      continue;
    }
    const std::vector<std::int64_t> near = index.near(ball.piece, ball.centre_m, ball.radius_m);
    const std::vector<std::int64_t> expected = touching(ball, balls);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end(), std::less_equal<>()));  // each once
    EXPECT_TRUE(std::includes(near.begin(), near.end(), expected.begin(), expected.end()));
  }
}

TEST(PlaceIndex, PassesOverWhatIsFar) {
  PlaceIndex index;
  for (int i = 0; i < 1000; ++i) index.add(i, 0, {0, 0, 10.0 * i}, 0.5);
  EXPECT_EQ(index.near(0, {0, 0, 5000}, 0.5), std::vector<std::int64_t>{500});
  EXPECT_TRUE(index.near(1, {0, 0, 5000}, 0.5).empty());
}

TEST(PlaceIndex, NanIsNear) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  PlaceIndex index;
  index.add(1, 0, {nan, 0, 0}, 1);
  index.add(2, 0, {0, 0, 0}, 1);
  EXPECT_EQ(index.near(0, {1e5, 0, 0}, 1), std::vector<std::int64_t>{1});
  EXPECT_EQ(index.near(0, {0, nan, 0}, 1), (std::vector<std::int64_t>{1, 2}));
}

}  // namespace
}  // namespace roadstereo::io
