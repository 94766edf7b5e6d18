#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "damage/contours.hpp"

namespace roadstereo {
namespace {

constexpr int contour_columns = 37, contour_rows = 23;

/// Cells of a region that have a 4-neighbour outside it, by the definition; beside the image as `beside` says.
std::vector<CellIndex> cells_beside(const BoxMask& region, bool beside) {
  const auto is_outside = [&](int i, int j) {
    return i < 0 || j < 0 || i >= contour_columns || j >= contour_rows ? beside : !region(i, j);
  };
  std::vector<CellIndex> cells;
  for (int j = 0; j < contour_rows; ++j) {
    for (int i = 0; i < contour_columns; ++i) {
      const bool any = is_outside(i - 1, j) || is_outside(i + 1, j) || is_outside(i, j - 1) || is_outside(i, j + 1);
      if (region(i, j) && any) cells.push_back({i, j});
    }
  }
  return cells;
}

void expect_cells(const std::vector<CellIndex>& cells, const std::vector<CellIndex>& expected) {
  ASSERT_EQ(cells.size(), expected.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_EQ(cells[k].column, expected[k].column);
    EXPECT_EQ(cells[k].row, expected[k].row);
  }
}

/// Boxes in the middle, at each border and over the whole image.
TEST(Contours, AreTheCellsWithANeighbourOutside) {
  std::mt19937 random(1);
  for (const CellBox& box : {CellBox{5, 4, 20, 15}, CellBox{0, 4, 20, 15}, CellBox{5, 0, 20, 15},
                             CellBox{5, 4, contour_columns - 1, 15}, CellBox{5, 4, 20, contour_rows - 1},
                             CellBox{0, 0, contour_columns - 1, contour_rows - 1}, CellBox{9, 9, 9, 9}}) {
    BoxMask region(box);
    for (int j = box.first_row; j <= box.last_row; ++j) {
      for (int i = box.first_column; i <= box.last_column; ++i) region.set(i, j, random() % 8 != 0);
    }
    expect_cells(rim_cells(region), cells_beside(region, true));
    expect_cells(contour_cells(region, contour_columns, contour_rows), cells_beside(region, false));
  }
}

TEST(Contours, OfNothingAreEmpty) {
  EXPECT_TRUE(rim_cells(BoxMask()).empty());
  EXPECT_TRUE(contour_cells(BoxMask(), contour_columns, contour_rows).empty());
}

TEST(CellBoxes, OverlapWhereTheyShareACell) {
  const CellBox box{3, 4, 6, 9};
  EXPECT_TRUE(box.overlaps({6, 9, 8, 12}));
  EXPECT_TRUE(box.overlaps({0, 0, 20, 20}));
  EXPECT_FALSE(box.overlaps({7, 4, 9, 9}));
  EXPECT_FALSE(box.overlaps({3, 10, 6, 12}));
  EXPECT_FALSE(box.overlaps({}));
  EXPECT_FALSE(CellBox().overlaps(box));
  CellBox both;
  both.add(CellBox());
  EXPECT_TRUE(both.empty());
  both.add(box);
  both.add(CellBox{1, 8, 2, 11});
  EXPECT_EQ(both.first_column, 1);
  EXPECT_EQ(both.first_row, 4);
  EXPECT_EQ(both.last_column, 6);
  EXPECT_EQ(both.last_row, 11);
}

}  // namespace
}  // namespace roadstereo
