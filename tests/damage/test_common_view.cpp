// Where both cameras see the road, against the plane solved for the column.

#include <gtest/gtest.h>

#include <cmath>

#include "damage/common_view.hpp"

namespace roadstereo {
namespace {

/// Cells of 2×2 pixels of a pair on a tilted plane. The right image shows the road from u − d(u, v) = 0 on, which is
/// u = (10 + 1.5 v) / (1 − 0.25): two cells more each row.
struct TiltedRoad {
  Image<float> transformed{240, 80, 30.0F};
  Image<std::int16_t> right{240, 80, std::int16_t{0}};
  Cells cells;
  DamageInput input;

  TiltedRoad() {
    for (int u = 0; u < transformed.width(); u += 3) transformed(u, 0) = 31;
    cells = make_cells(transformed, {}, 0, 2, 1);
    input.transformed = transformed;
    input.right = right;
    input.plane = DisparityPlane{10, 1.5, 0.25};  // of rows, of columns
  }
  static double first_u(double v) { return (10 + 1.5 * v) / 0.75; }
};

TEST(CommonView, BeginsWhereMatchOfRoadEntersRightImage) {
  const TiltedRoad scene;
  const CommonView view(scene.input, scene.cells);
  for (int j = 0; j < scene.cells.height(); ++j) {
    const double first_u = TiltedRoad::first_u(2 * j + 0.5);  // a cell's middle is at 2 i + 0.5, 2 j + 0.5
    EXPECT_EQ(view.first_column(j), static_cast<int>(std::ceil((first_u - 0.5) / 2))) << j;
    EXPECT_FALSE(view.contains(view.first_column(j) - 1, j));
    EXPECT_TRUE(view.contains(view.first_column(j), j));
    EXPECT_TRUE(view.is_on_border(view.first_column(j), j));
    EXPECT_TRUE(view.is_at_side(view.first_column(j), j));
    EXPECT_TRUE(view.is_at_side(119, j));
    EXPECT_FALSE(view.is_at_side(view.first_column(j) + 1, j));
  }
  // The neighbour below, only, is outside.
  EXPECT_TRUE(view.is_on_border(view.first_column(20) + 1, 20));
  EXPECT_FALSE(view.is_on_border(view.first_column(20) + 2, 20));
  EXPECT_FALSE(view.is_on_border(118, 20));
  EXPECT_TRUE(view.is_on_border(119, 20));
  EXPECT_TRUE(view.is_on_border(118, 0));
  EXPECT_TRUE(view.is_on_border(118, 39));
}

TEST(CommonView, EndsAtMask) {
  TiltedRoad scene;
  Image<std::uint8_t> mask(scene.cells.image_width, scene.cells.image_height, 0);
  mask(201, 60) = 1;  // of cell (100, 30)
  scene.input.mask = mask;
  const CommonView view(scene.input, scene.cells);
  EXPECT_FALSE(view.contains(100, 30));
  EXPECT_TRUE(view.contains(101, 30));
  EXPECT_TRUE(view.is_on_border(101, 30));
  EXPECT_TRUE(view.is_on_border(100, 31));
  EXPECT_FALSE(view.is_on_border(102, 30));
  Image<std::uint8_t> known(scene.cells.width(), scene.cells.height(), 0);
  view.fill_outside(known);
  EXPECT_EQ(known(100, 30), 255);
  EXPECT_EQ(known(101, 30), 0);
  Image<std::uint8_t> hidden(scene.cells.width(), scene.cells.height(), 0);
  view.fill_masked(hidden);
  EXPECT_EQ(hidden(100, 30), 255);
  EXPECT_EQ(hidden(101, 30), 0);
  EXPECT_EQ(hidden(0, 30), 0) << "outside, but the left picture shows it";
}

TEST(CommonView, IsWholeImageWithoutPlaneOrRightImage) {
  TiltedRoad scene;
  scene.input.plane.reset();
  EXPECT_EQ(CommonView(scene.input, scene.cells).first_column(20), 0);
  scene.input.plane = DisparityPlane{10, 1.5, 0.25};
  scene.input.right = {};
  EXPECT_EQ(CommonView(scene.input, scene.cells).first_column(20), 0);
}

TEST(CommonView, RemovesOnlyWhatIsOutside) {
  TiltedRoad scene;
  const CommonView view(scene.input, scene.cells);
  view.remove_outside(scene.cells);
  for (int j = 0; j < scene.cells.height(); ++j) {
    for (int i = 0; i < scene.cells.width(); ++i) {
      EXPECT_EQ(std::isnan(scene.cells.value(i, j)), i < view.first_column(j));
    }
  }
}

TEST(CommonView, RoadThatIsTooCloseIsNowhereInView) {
  TiltedRoad scene;
  scene.input.plane = DisparityPlane{300, 0, 0};
  const CommonView view(scene.input, scene.cells);
  EXPECT_EQ(view.first_column(0), scene.cells.width());
  view.remove_outside(scene.cells);
  EXPECT_TRUE(std::isnan(scene.cells.value(119, 39)));
}

}  // namespace
}  // namespace roadstereo
