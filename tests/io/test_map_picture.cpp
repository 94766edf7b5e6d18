// The picture of a map for reports, decoded again.

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/map_picture.hpp"

namespace roadstereo::io {
namespace {

/// A road of 40 × 100 cells from (0, 0) in a box that is larger: green up to y = 50, then blue; 20 mm low in the middle
/// of the blue half.
MapRaster read_strip(const MapBox& box) {
  MapRaster raster;
  raster.box = box;
  raster.height.assign(box.columns, box.rows, std::numeric_limits<float>::quiet_NaN());
  raster.sigma.assign(box.columns, box.rows, 0.001F);
  raster.colour.assign(box.columns, box.rows, {0, 0, 0});
  raster.views.assign(box.columns, box.rows, 0);
  for (int v = 0; v < box.rows; ++v) {
    for (int u = 0; u < box.columns; ++u) {
      const int i = box.i0 + u, j = box.j0 + box.rows - 1 - v;
      if (i < 0 || i >= 40 || j < 0 || j >= 100) continue;
      const bool low = i >= 10 && i < 30 && j >= 65 && j < 85;
      raster.height(u, v) = low ? -0.02F : 0.0F;
      raster.colour(u, v) = j < 50 ? std::array<std::uint8_t, 3>{0, 200, 0} : std::array<std::uint8_t, 3>{0, 0, 200};
      raster.views(u, v) = 3;
    }
  }
  return raster;
}

void expect_colour(const cv::Mat& picture, int u, int v, const cv::Vec3b& bgr) {
  const cv::Vec3b& seen = picture.at<cv::Vec3b>(v, u);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], bgr[k], 25) << u << ", " << v;  // JPEG
}

// 100 cells along y become 1200 pixels along u: 12 a cell, and 480 rows; +y to the right, +x down.
TEST(MapPicture, LongRoadIsCroppedEnlargedAndTurned) {
  const MapReference reference{0.02, 0, 0, 0, ""};
  const auto jpeg = map_picture({-128, -128, 256, 384}, reference, read_strip, read_strip, {});
  const cv::Mat picture = cv::imdecode(jpeg, cv::IMREAD_COLOR);
  ASSERT_GT(picture.cols, 1200);  // with a scale bar
  ASSERT_GT(picture.rows, 2 * 480);
  expect_colour(picture, 20, 20, {0, 200, 0});
  expect_colour(picture, 580, 470, {0, 200, 0});
  expect_colour(picture, 620, 10, {200, 0, 0});
  expect_colour(picture, 1190, 470, {200, 0, 0});
  const int relief = 480 + 10;
  expect_colour(picture, 300, relief + 240, {228, 228, 228});  // the road
  EXPECT_GT(picture.at<cv::Vec3b>(relief + 240, 900)[2], 60);  // y = 75: red, below the road
  EXPECT_LT(picture.at<cv::Vec3b>(relief + 240, 900)[1], 30);
  expect_colour(picture, 1150, relief + 240, {228, 228, 228});
}

TEST(MapPicture, FootprintsAreOutlinedInBothPanels) {
  RoadDamageRecord record;
  record.id = 7;
  record.severity = Severity::high;
  record.best.at_m = {0.4, 1.5};
  for (int j = 65; j < 85; ++j) {
    for (int i = 10; i < 30; ++i) record.best.footprint.push_back({i, j});
  }
  const MapReference reference{0.02, 0, 0, 0, ""};  // cells as large as those of footprints
  const std::vector<RoadDamageRecord> damages{record};
  const cv::Mat plain = cv::imdecode(map_picture({0, 0, 40, 100}, reference, read_strip, read_strip, {}), 1);
  const cv::Mat drawn = cv::imdecode(map_picture({0, 0, 40, 100}, reference, read_strip, read_strip, damages), 1);
  for (const int top : {0, 490}) {
    // The centres of the outermost cells: y = 65.5 and 84.5, x = 10.5 and 29.5; red {214, 39, 40}.
    for (const cv::Point at : {cv::Point(786, 200), cv::Point(1014, 200), cv::Point(850, 126), cv::Point(850, 354)}) {
      const auto& bgr = drawn.at<cv::Vec3b>(top + at.y, at.x);
      EXPECT_GT(bgr[2], 120) << at;
      EXPECT_LT(bgr[0], 110) << at;
    }
    EXPECT_EQ(cv::norm(plain(cv::Rect(0, top, 760, 480)), drawn(cv::Rect(0, top, 760, 480)), cv::NORM_INF), 0);
  }
}

TEST(MapPicture, RejectsEmptyMap) {
  EXPECT_THROW(map_picture({}, {0.02, 0, 0, 0, ""}, read_strip, read_strip, {}), Error);
  EXPECT_THROW(map_picture({500, 500, 64, 64}, {0.02, 0, 0, 0, ""}, read_strip, read_strip, {}), Error);
}

}  // namespace
}  // namespace roadstereo::io
