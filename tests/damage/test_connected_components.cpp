// Masks of cells against brute force: connected regions, enclosed gaps, growing and shrinking.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>

#include "damage/connected_components.hpp"
#include "damage/morphology.hpp"

namespace roadstereo {
namespace {

Image<std::uint8_t> random_mask(int width, int height, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution set(share);
  Image<std::uint8_t> mask(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) mask(i, j) = set(random) ? 255 : 0;
  }
  return mask;
}

/// Numbers every cell by the smallest cell that it hangs together with: the smallest number spreads until nothing
/// changes. −1 where the mask is not `wanted`.
Image<int> spread_numbers(const Image<std::uint8_t>& mask, bool wanted) {
  Image<int> number(mask.width(), mask.height(), -1);
  for (int j = 0; j < mask.height(); ++j) {
    for (int i = 0; i < mask.width(); ++i) {
      if ((mask(i, j) != 0) == wanted) number(i, j) = j * mask.width() + i;
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    const auto take = [&](int i, int j, int di, int dj) {
      if (i + di < 0 || j + dj < 0 || i + di >= mask.width() || j + dj >= mask.height()) return;
      const int other = number(i + di, j + dj);
      if (other < 0 || other >= number(i, j)) return;
      number(i, j) = other;
      changed = true;
    };
    for (int j = 0; j < mask.height(); ++j) {
      for (int i = 0; i < mask.width(); ++i) {
        for (const auto& [di, dj] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
          take(i, j, di, dj);
        }
      }
    }
  }
  return number;
}

class RandomMasks : public testing::TestWithParam<int> {
 protected:
  Image<std::uint8_t> mask() const {
    const int k = GetParam();
    return random_mask(1 + 7 * k % 41, 1 + 11 * k % 37, 0.2 + 0.1 * (k % 6), static_cast<std::uint32_t>(k));
  }
};

TEST_P(RandomMasks, ConnectedRegionsMatchBruteForce) {
  const Image<std::uint8_t> cells = mask();
  const Image<int> number = spread_numbers(cells, true);
  const ConnectedComponents regions(cells);
  std::set<int> numbers;
  std::size_t set = 0;
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      if (cells(i, j) == 0) continue;
      numbers.insert(number(i, j));
      ++set;
    }
  }
  ASSERT_EQ(regions.size(), numbers.size());
  std::size_t total = 0;
  int last_first = -1;
  for (const ConnectedComponent& region : regions) {
    total += region.size;
    const int first = region.runs.front().row * cells.width() + region.runs.front().first;
    EXPECT_GT(first, last_first) << "in the order of their first cells";
    last_first = first;
    int u0 = 1000, v0 = 1000, u1 = -1, v1 = -1;
    std::set<int> held;
    for (const CellRun& run : region.runs) {
      for (int i = run.first; i <= run.last; ++i) {
        EXPECT_EQ(number(i, run.row), first);
        held.insert(run.row * cells.width() + i);
      }
      u0 = std::min(u0, run.first);
      v0 = std::min(v0, run.row);
      u1 = std::max(u1, run.last);
      v1 = std::max(v1, run.row);
    }
    EXPECT_EQ(held.size(), region.size);
    EXPECT_EQ(region.box.first_column, u0);
    EXPECT_EQ(region.box.first_row, v0);
    EXPECT_EQ(region.box.last_column, u1);
    EXPECT_EQ(region.box.last_row, v1);
    EXPECT_EQ(region.touches_border, u0 == 0 || v0 == 0 || u1 == cells.width() - 1 || v1 == cells.height() - 1);
  }
  EXPECT_EQ(total, set);
}

TEST_P(RandomMasks, FillEnclosedMatchesBruteForce) {
  const Image<std::uint8_t> before = mask();
  const Image<int> number = spread_numbers(before, false);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{10'000}}) {
    Image<std::uint8_t> filled = before;
    fill_holes(filled, most);
    for (int j = 0; j < before.height(); ++j) {
      for (int i = 0; i < before.width(); ++i) {
        if (before(i, j) != 0) {
          EXPECT_EQ(filled(i, j), before(i, j));
          continue;
        }
        std::size_t size = 0;
        bool at_border = false;
        for (int y = 0; y < before.height(); ++y) {
          for (int x = 0; x < before.width(); ++x) {
            if (number(x, y) != number(i, j)) continue;
            ++size;
            at_border |= x == 0 || y == 0 || x + 1 == before.width() || y + 1 == before.height();
          }
        }
        EXPECT_EQ(filled(i, j) != 0, !at_border && size <= most) << i << ", " << j;
      }
    }
  }
}

TEST_P(RandomMasks, GrowAndShrinkMatchBruteForce) {
  const Image<std::uint8_t> cells = mask();
  for (const int radius : {0, 1, 2, 5, 60}) {
    const Image<std::uint8_t> grown = dilate(cells, radius, 1);
    const Image<std::uint8_t> shrunk = erode(cells, radius, 1);
    for (int j = 0; j < cells.height(); ++j) {
      for (int i = 0; i < cells.width(); ++i) {
        bool any = false, all = true;
        for (int y = std::max(0, j - radius); y <= std::min(cells.height() - 1, j + radius); ++y) {
          for (int x = std::max(0, i - radius); x <= std::min(cells.width() - 1, i + radius); ++x) {
            any |= cells(x, y) != 0;
            all &= cells(x, y) != 0;
          }
        }
        ASSERT_EQ(grown(i, j), any ? 255 : 0) << "radius " << radius << " at " << i << ", " << j;
        ASSERT_EQ(shrunk(i, j), all ? 255 : 0) << "radius " << radius << " at " << i << ", " << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMasks, testing::Range(1, 13));

TEST(CellBox, GrowsWithinImage) {
  CellBox box;
  EXPECT_TRUE(box.empty());
  box.add(5, 7);
  box.add(3, 9);
  const CellBox grown = box.grown(4, 8, 40);
  EXPECT_EQ(grown.first_column, 0);
  EXPECT_EQ(grown.first_row, 3);
  EXPECT_EQ(grown.last_column, 7);
  EXPECT_EQ(grown.last_row, 13);
}

}  // namespace
}  // namespace roadstereo
