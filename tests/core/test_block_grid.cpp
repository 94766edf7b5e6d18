// Grids of 8×8 blocks that begin anywhere in the picture.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "core/block_grid.hpp"
#include "core/deblocking.hpp"
#include "roadstereo/image.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// Texture of up to `texture` grey values and a level for each block of up to `step`; the first blocks begin at (x, y).
GreyImage image_with_grid_at(int x, int y, double texture, double step) {
  GreyImage image(640, 360);
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const double level =
          1000 + texture * test::lattice(u, v, 1) + step * test::lattice((u + 8 - x) / 8, (v + 8 - y) / 8, 2);
      image(u, v) = static_cast<std::int16_t>(level);
    }
  }
  return image;
}

// A step between pixels of a block is |x − y|, of uniform numbers in [0, 1) 1/3 on average; with another difference of
// that kind and size added, 7/15: 40 % more.
TEST(BlockGrid, IsMeasuredWhereverItBegins) {
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 7}, {3, 5}, {4, 4}, {7, 2}}) {
    EXPECT_NEAR(block_grid_excess(image_with_grid_at(x, y, 300, 300)), 0.4, 0.04) << x << ", " << y;
    const GreyImage strong = image_with_grid_at(x, y, 60, 600);
    EXPECT_GT(block_grid_excess(strong), 4) << x << ", " << y;
    if (x != 0) {
      EXPECT_LT(measure_block_steps(strong).excess(), 0.1) << x << ", " << y;
    }
  }
}

TEST(BlockGrid, IsNoneWithoutCompression) {
  for (const double texture : {0.0, 100.0, 3000.0})
    EXPECT_EQ(block_grid_excess(image_with_grid_at(0, 0, texture, 0)), 0);
  // Of all columns and rows a single edge is the highest step.
  GreyImage edge = image_with_grid_at(0, 0, 20, 0);
  for (int v = 0; v < edge.height(); ++v) {
    for (int u = 0; u < edge.width(); ++u)
      edge(u, v) = static_cast<std::int16_t>(edge(u, v) + (u > 99) * 900 + (v > 99) * 900);
  }
  EXPECT_EQ(block_grid_excess(edge), 0);
  // Stripes of eight columns are no blocks.
  GreyImage stripes = image_with_grid_at(0, 0, 20, 0);
  for (int v = 0; v < stripes.height(); ++v) {
    for (int u = 0; u < stripes.width(); ++u)
      stripes(u, v) = static_cast<std::int16_t>(stripes(u, v) + u / 8 % 2 * 500);
  }
  EXPECT_EQ(block_grid_excess(stripes), 0);
}

TEST(BlockGrid, SmallestImages) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {9, 9}, {10, 10}, {32, 32}, {64, 40}}) {
    GreyImage image(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) image(u, v) = static_cast<std::int16_t>(1000 * test::lattice(u, v, 1));
    }
    EXPECT_EQ(block_grid_excess(image), 0) << width << "×" << height << ", too few borders";
  }
}

}  // namespace
}  // namespace roadstereo
