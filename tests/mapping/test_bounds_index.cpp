#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "mapping/bounds_index.hpp"

namespace roadstereo {
namespace {

TEST(BoundsIndex, FindsAllThatBruteForceFinds) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int32_t> place(-2000, 2000), side(-1, 150);
  std::vector<std::pair<std::size_t, CellBounds>> boxes;
  BoundsIndex index;
  for (std::size_t i = 0; i < 2000; ++i) {
    CellBounds box;
    box.first = {place(random), place(random)};
    const std::int32_t more = i % 100 == 0 ? 3000 : 0;  // larger than the index takes block by block
    box.last = {box.first[0] + side(random) + more, box.first[1] + side(random) + more};
    if (i % 2 == 0) {
      boxes.emplace_back(random() % 700, box);
      index.add(boxes.back().first, box);
      continue;
    }
    std::vector<std::size_t> expected;
    for (const auto& [number, other] : boxes) {
      if (box.overlaps(box) && other.overlaps(other) && box.overlaps(other)) expected.push_back(number);
    }
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    const std::vector<std::size_t> near = index.near(box);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end(), std::less_equal<>()));  // each once
    EXPECT_TRUE(std::includes(near.begin(), near.end(), expected.begin(), expected.end()));
  }
}

TEST(BoundsIndex, PassesOverWhatIsFar) {
  BoundsIndex index;
  for (std::int32_t i = 0; i < 1000; ++i) {
    index.add(static_cast<std::size_t>(i), {{0, 1000 * i}, {9, 1000 * i + 9}});
  }
  EXPECT_EQ(index.near({{5, 500'005}, {20, 500'020}}), std::vector<std::size_t>{500});
}

}  // namespace
}  // namespace roadstereo
