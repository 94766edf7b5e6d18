// Maps of exact disparities: known heights come back, noise shrinks, what moves does not stay, memory is bounded.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/map_damage.hpp"
#include "roadstereo/road_map.hpp"
#include "roadstereo/road_relief.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

class RoadMapTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("roadstereo_map_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
               std::to_string(::getpid()));
  }
  RoadMapOptions options() const {
    RoadMapOptions options;
    options.cell_m = 0.01;
    options.tile_cells = 32;
    options.threads = 1;
    options.common_share = 0;
    return options;
  }
  fs::path folder_;
};

TEST(RigidTransform, InverseUndoesTransform) {
  const RigidTransform pose = compose(looking_down(1, -2, 3), {0, -1, 0, 4, 0.6, 0, -0.8, 5, 0.8, 0, 0.6, 6});
  const RigidTransform identity = compose(inverse(pose), pose);
  const RigidTransform expected{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  for (std::size_t k = 0; k < identity.size(); ++k) EXPECT_NEAR(identity[k], expected[k], 1e-12) << k;
}

TEST_F(RoadMapTest, ExactDisparitiesGiveExactHeights) {
  const Step step{0.1, 0.05, 0.2, 0.05};
  RoadMap map(folder_, options());
  for (const double x : {-0.1, 0.0, 0.15}) {
    const TestFrame view(looking_down(x, 0.5 * x, 2 + x), step, 0, 1);
    EXPECT_GT(map.add(view.frame), 10'000U);
  }
  const MapRaster raster = map.read({-50, -40, 100, 80});
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      const double x = (-50 + u + 0.5) * 0.01, y = (-40 + 79 - v + 0.5) * 0.01;
      if (std::abs(std::hypot(x - step.x, y - step.y) - step.radius_m) < 0.04) continue;  // the edge, two pixels wide
      ASSERT_NEAR(raster.height(u, v), step.height(x, y), 1e-4) << x << ", " << y;
    }
  }
}

// Cells wider than the nodes that the smooth surface has by default.
TEST_F(RoadMapTest, CoarseCellsHaveRelief) {
  RoadMapOptions coarse = options();
  coarse.cell_m = 0.4;
  RoadMap map(folder_, coarse);
  for (int j = -4; j <= 4; ++j) {
    for (int i = -4; i <= 4; ++i) map.add(TestFrame(looking_down(0.8 * i, 0.8 * j, 2), {}, 0, 1).frame);
  }
  const MapRaster relief = read_relief(map, {-4, -4, 8, 8});
  for (std::size_t k = 0; k < relief.height.pixels(); ++k) ASSERT_NEAR(relief.height.row(0)[k], 0, 1e-4) << k;
}

// Independent noise of n frames: the error of a cell is that of one divided by √n, and the standard error says so.
TEST_F(RoadMapTest, StandardErrorIsThatOfTheMean) {
  constexpr int frames = 40;
  RoadMap map(folder_, options());
  for (int i = 0; i < frames; ++i) {
    map.add(TestFrame(looking_down(0.01 * i, 0.013 * i, 2), {}, 0.1, static_cast<unsigned>(i + 1)).frame);
  }
  const MapRaster raster = map.read({-20, -20, 60, 60});
  double squares = 0, predicted = 0;
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 60; ++u) {
      squares += raster.height(u, v) * raster.height(u, v);
      predicted += raster.sigma(u, v) * raster.sigma(u, v);
      EXPECT_GE(raster.views(u, v), frames - 2);
    }
  }
  // 0.1 px are 0.1·Z²/(f·b) = 16.7 mm.
  const double single = 0.1 * 4 / (120 * 0.2) * 2.0 / 3, expected = single / std::sqrt(frames);
  EXPECT_NEAR(std::sqrt(squares / 3600), expected, 0.15 * expected);
  EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.2);
  EXPECT_LT(map.view_factor(), 1.2);
}

// Errors of a first-order autoregression with r = 0.5: (1 + r)/(1 − r) = 3 frames are worth one.
TEST_F(RoadMapTest, MeasuresCorrelationOfSuccessiveFrames) {
  constexpr double r = 0.5, noise_px = 0.02;  // little: at the borders larger noise moves the pixel of a cell
  RoadMap map(folder_, options());
  std::mt19937 random(5);
  std::normal_distribution<double> fresh(0, noise_px);
  Image<float> error(width, height, 0);
  for (int i = 0; i < 60; ++i) {
    TestFrame view(looking_down(0, 0, 2), {}, 0, 1);
    view.sigma.assign(width, height, static_cast<float>(noise_px * 2 / 3));
    for (std::size_t k = 0; k < error.pixels(); ++k) {
      float& e = error.row(0)[k];
      e = static_cast<float>(i == 0 ? fresh(random) : r * e + std::sqrt(1 - r * r) * fresh(random));
      view.disparity.row(0)[k] += e;
    }
    map.add(view.frame);
  }
  EXPECT_NEAR(map.view_factor(), 3, 0.3);
  const MapRaster raster = map.read({-50, -40, 100, 80});
  double squares = 0, predicted = 0;
  for (std::size_t k = 0; k < raster.height.pixels(); ++k) {
    squares += raster.height.row(0)[k] * raster.height.row(0)[k];
    predicted += raster.sigma.row(0)[k] * raster.sigma.row(0)[k];
  }
  EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.1);
}

// A box passes: it is there in the first frames over a cell, and gone in the others.
TEST_F(RoadMapTest, WhatMovesDoesNotStay) {
  RoadMap map(folder_, options());
  for (int i = 0; i < 7; ++i) {
    const Step box{0, 0, 0.15, i < 3 ? -0.2 : 0.0};
    map.add(TestFrame(looking_down(0, 0, 2), box, 0.02, static_cast<unsigned>(i + 1)).frame);
  }
  const MapRaster raster = map.read({-5, -5, 10, 10});
  for (int v = 0; v < 10; ++v) {
    for (int u = 0; u < 10; ++u) EXPECT_NEAR(raster.height(u, v), 0, 0.01);
  }
}

TEST_F(RoadMapTest, TilesOnDiskChangeNothing) {
  RoadMapOptions few = options(), many = options();
  few.max_tiles = 4;
  RoadMap small(folder_ / "few", few), large(folder_ / "many", many);
  for (int i = 0; i < 3; ++i) {
    const TestFrame view(looking_down(0.2 * i, 0, 2), {0.1, 0, 0.1, 0.04}, 0.05, static_cast<unsigned>(i + 1));
    small.add(view.frame);
    large.add(view.frame);
  }
  ASSERT_GT(large.tiles(), 20U);
  EXPECT_EQ(small.tiles(), large.tiles());
  const MapRaster a = small.read(small.bounds()), b = large.read(large.bounds());
  EXPECT_EQ(a.views, b.views);
  for (std::size_t k = 0; k < a.height.pixels(); ++k) {
    const float one = a.height.row(0)[k], other = b.height.row(0)[k];
    EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other)));
  }
  EXPECT_FALSE(fs::is_empty(folder_ / "few"));
}

// As after a kill: tiles newer than the save are on disk, some of them of places that the save has.
TEST_F(RoadMapTest, ContinuesFromSaveBitForBit) {
  RoadMapOptions few = options();
  few.max_tiles = 4;
  const auto view = [](int i) {
    return TestFrame(looking_down(0.1 * i, 0, 2), {0.1, 0, 0.1, 0.04}, 0.05, static_cast<unsigned>(i + 1));
  };
  RoadMap whole(folder_ / "whole", few);
  for (int i = 0; i < 6; ++i) whole.add(view(i).frame);
  SavedMap saved;
  {
    RoadMap killed(folder_ / "killed", few);
    killed.keep();
    for (int i = 0; i < 4; ++i) {
      killed.add(view(i).frame);
      if (i != 0 && i != 2) continue;
      saved = killed.save();
      killed.commit();
    }
  }
  RoadMap continued(folder_ / "killed", few, saved);
  for (int i = 3; i < 6; ++i) continued.add(view(i).frame);
  const MapRaster a = whole.read(whole.bounds()), b = continued.read(whole.bounds());
  EXPECT_EQ(a.views, b.views);
  for (std::size_t k = 0; k < a.height.pixels(); ++k) {
    if (a.views.row(0)[k] == 0) continue;
    ASSERT_EQ(a.height.row(0)[k], b.height.row(0)[k]);
    ASSERT_EQ(a.sigma.row(0)[k], b.sigma.row(0)[k]);
  }
  const SavedMap all = continued.save();
  continued.commit();
  EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / "killed"), {})), all.tiles.size());
  fs::remove(fs::directory_iterator(folder_ / "killed")->path());
  EXPECT_THROW(RoadMap(folder_ / "killed", few, all), Error);
}

// The road is inclined by 5 %; the relief is that of the step alone.
TEST_F(RoadMapTest, ReliefIsHeightAboveInclinedRoad) {
  const Step step{0.1, 0.05, 0.2, 0.05};
  RoadMap map(folder_, options());
  const double slope = std::atan(0.05);
  const RigidTransform tilt{std::cos(slope), 0, -std::sin(slope), 0, 0, 1, 0, 0,
                            std::sin(slope), 0, std::cos(slope),  0};
  for (const double x : {-0.1, 0.0, 0.15}) {
    TestFrame view(looking_down(x, 0, 2), step, 0, 1);
    view.frame.camera_to_map = compose(tilt, view.frame.camera_to_map);
    map.add(view.frame);
  }
  const MapRaster heights = map.read({-50, -40, 100, 80});
  const MapRaster relief = read_relief(map, {-50, -40, 100, 80});
  EXPECT_NEAR(heights.height(95, 40) - heights.height(0, 40), 0.95 * 0.05, 0.002);
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      const double x = (-50 + u + 0.5) * 0.01, y = (-40 + 79 - v + 0.5) * 0.01;
      if (std::abs(std::hypot(x - step.x, y - step.y) - step.radius_m) < 0.04) continue;
      ASSERT_NEAR(relief.height(u, v), step.height(x, y), 1e-3) << x << ", " << y;
    }
  }
}

TEST_F(RoadMapTest, RemovesItsFolder) {
  { const RoadMap map(folder_, options()); }
  EXPECT_FALSE(fs::exists(folder_));
}

// What a map did not write it neither removes nor takes for its own.
TEST_F(RoadMapTest, LeavesFilesOfOthersAlone) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "3_-4.1") << "a tile of an earlier map";
  {
    RoadMapOptions few = options();
    few.max_tiles = 4;
    RoadMap map(folder_, few);
    EXPECT_FALSE(fs::exists(folder_ / "3_-4.1"));
    map.add(TestFrame(looking_down(0, 0, 2), {}, 0, 1).frame);
    EXPECT_FALSE(fs::is_empty(folder_));
    std::ofstream(folder_ / "note.txt") << "mine";
  }
  EXPECT_TRUE(fs::exists(folder_ / "note.txt"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  try {
    const RoadMap map(folder_, options());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("holds note.txt"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::exists(folder_ / "note.txt"));
  fs::remove_all(folder_);
}

TEST_F(RoadMapTest, KeepsToItsFolderWhenTheProcessMoves) {
  fs::create_directories(folder_);
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  {
    RoadMap map("tiles", options());
    fs::create_directories("elsewhere/tiles");
    fs::current_path("elsewhere");
    map.add(TestFrame(looking_down(0, 0, 2), {}, 0, 1).frame);
  }
  EXPECT_TRUE(fs::exists("tiles"));
  EXPECT_FALSE(fs::exists(folder_ / "tiles"));
  fs::current_path(before);
  fs::remove_all(folder_);
}

TEST_F(RoadMapTest, RejectsMotionsThatAreNotRigidOrLeadTooFar) {
  RoadMap map(folder_, options());
  const RigidTransform good = looking_down(0, 0, 2);
  for (const double factor : {2.0, 0.5, -1.0, std::nan("")}) {
    TestFrame view(good, {}, 0, 1);
    for (const std::size_t k : {0, 1, 2, 4, 5, 6, 8, 9, 10}) view.frame.camera_to_map[k] *= factor;
    EXPECT_THROW(map.add(view.frame), Error) << factor;
  }
  TestFrame mirrored(good, {}, 0, 1);
  for (const std::size_t k : {0, 4, 8}) mirrored.frame.camera_to_map[k] *= -1;
  EXPECT_THROW(map.add(mirrored.frame), Error);
  for (const double x : {std::nan(""), 1e300, 1e7, -1e7}) {
    TestFrame view(good, {}, 0, 1);
    view.frame.camera_to_map[3] = x;
    EXPECT_THROW(map.add(view.frame), Error) << x;
  }
  EXPECT_TRUE(map.bounds().empty());
}

TEST_F(RoadMapTest, RejectsImpossibleBoxes) {
  const RoadMap map(folder_, options());
  for (const MapBox& box : {MapBox{0, 0, -1, 5}, MapBox{0, 0, 5, -1}, MapBox{0, 0, 100'000, 100'000},
                            MapBox{2'147'483'000, 0, 1000, 1}, MapBox{-2'147'483'647, 0, 1, 1}}) {
    EXPECT_THROW(map.read(box), Error) << box.i0 << " " << box.columns << " " << box.rows;
  }
}

TEST_F(RoadMapTest, SuggestsCellsThatMapsCanHave) {
  const TestFrame view(looking_down(0, 0, 2), {}, 0, 1);
  StereoCalibration fine = view.frame.calibration;
  fine.focal_px *= 1000;
  fine.width = fine.height = 0;  // as of files without a size
  const ImageView<const float> map = view.frame.disparity;
  EXPECT_DOUBLE_EQ(suggested_cell_m({view.frame.road.a0 * 1000, 0, 0}, fine, map.width(), map.height()), 0.0005);
}

TEST_F(RoadMapTest, RejectsWrongSizesAndPoses) {
  RoadMap map(folder_, options());
  TestFrame view(looking_down(0, 0, 2), {}, 0, 1);
  view.frame.camera_to_map = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 2};  // looks along y, as the axes of a camera lie
  EXPECT_THROW(map.add(view.frame), Error);
  TestFrame other(looking_down(0, 0, 2), {}, 0, 1);
  const Image<float> small(10, 10, 0.1F);
  other.frame.sigma = small;
  EXPECT_THROW(map.add(other.frame), Error);
  RoadMapOptions wrong = options();
  wrong.cell_m = 0;
  EXPECT_THROW(RoadMap(folder_, wrong), Error);
}

TEST_F(RoadMapTest, DamageThatNoFrameResolvesIsFoundInMap) {
  const Step step{0.1, 0.05, 0.25, 0.012};
  RoadMap map(folder_, options());
  for (int i = 0; i < 30; ++i) {
    map.add(TestFrame(looking_down(0.01 * i - 0.15, 0.003 * i, 2), step, 0.1, static_cast<unsigned>(i + 1)).frame);
  }
  RoadMap single(folder_ / "single", options());
  single.add(TestFrame(looking_down(0, 0, 2), step, 0.1, 1).frame);
  EXPECT_TRUE(find_map_damage(single, {}).empty());
  const std::vector<MapDamage> found = find_map_damage(map, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].at_m[0], step.x, 0.02);
  EXPECT_NEAR(found[0].at_m[1], step.y, 0.02);
  EXPECT_NEAR(found[0].damage.metrics->max_depth_m.value, step.depth_m, 0.003);
  const Measurement& area = found[0].damage.metrics->area_m2;
  EXPECT_NEAR(area.value, 3.1416 * 0.25 * 0.25, 2 * area.std_error);
  EXPECT_NEAR(static_cast<double>(found[0].footprint.size()) * footprint_m * footprint_m, area.value, 0.03);
}

/// A rut of 20 mm that leads 60° to the right of the map's y axis, as the path of the camera does.
TEST_F(RoadMapTest, RutIsFoundAlongPath) {
  struct Rut {
    double height(double x, double y) const {
      const double across = (0.5 * x - std::sqrt(0.75) * y) / 0.35;
      return -0.02 * std::max(0.0, 1 - across * across);
    }
  };
  RoadMapOptions coarse = options();
  coarse.cell_m = 0.02;
  RoadMap map(folder_, coarse);
  std::vector<std::array<double, 2>> path;
  for (int i = 0; i < 8; ++i) {
    path.push_back({std::sqrt(0.75) * (0.2 * i - 0.7), 0.5 * (0.2 * i - 0.7)});
    constexpr double noise_px = 0.01;
    TestFrame view(looking_down(path.back()[0], path.back()[1], 3), Rut(), noise_px, static_cast<unsigned>(i + 1));
    view.sigma.assign(width, height, static_cast<float>(noise_px));
    map.add(view.frame);
  }
  using Paths = std::vector<std::vector<std::array<double, 2>>>;
  const auto ruts = [&](const Paths& paths) {
    int count = 0;
    for (const MapDamage& found : find_map_damage(map, {}, paths)) {
      count += found.damage.metrics->distress == Distress::rut ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(ruts({}), 0);
  EXPECT_EQ(ruts(Paths{path}), 1);
  std::vector<std::array<double, 2>> mirrored = path;
  for (auto& point : mirrored) point[0] = -point[0];
  EXPECT_EQ(ruts(Paths{mirrored}), 0);
}

// The map's heights are as precise with coarse cells, and so is what is found in them.
TEST_F(RoadMapTest, DamageIsAsSignificantInCoarseCells) {
  const Step step{0.1, 0.05, 0.3, 0.04};
  std::vector<double> significances;
  for (const double cell_m : {0.01, 0.02, 0.04}) {
    RoadMapOptions coarse = options();
    coarse.cell_m = cell_m;
    RoadMap map(folder_ / std::to_string(cell_m), coarse);
    for (int i = 0; i < 12; ++i) {
      map.add(TestFrame(looking_down(0.02 * i - 0.1, 0.003 * i, 2), step, 0.05, static_cast<unsigned>(i + 1)).frame);
    }
    const std::vector<MapDamage> found = find_map_damage(map, {});
    ASSERT_EQ(found.size(), 1U) << cell_m;
    significances.push_back(found[0].damage.evidence.depth_significance);
  }
  EXPECT_NEAR(significances[1] / significances[0], 1, 0.25);
  EXPECT_NEAR(significances[2] / significances[0], 1, 0.25);
}

// Many frames make the errors small: the rig that sees the map must stay one that a calibration allows.
TEST_F(RoadMapTest, DamageIsFoundInManyFrames) {
  RoadMapOptions coarse = options();
  coarse.cell_m = 0.02;
  RoadMap map(folder_, coarse);
  for (int i = 0; i < 40; ++i) {
    map.add(TestFrame(looking_down(0.005 * i - 0.1, 0.001 * i, 2), {0.1, 0.05, 0.3, 0.06}, 0.05,
                      static_cast<unsigned>(i + 1))
                .frame);
    if (i == 0 || i == 9 || i == 39) {
      EXPECT_EQ(find_map_damage(map, {}).size(), 1U) << i;
    }
  }
}

// A frame that is turned by 45° shows half of the box around it.
TEST_F(RoadMapTest, TilesHaveMeasuredCells) {
  RoadMapOptions small = options();
  small.tile_cells = 16;
  RoadMap map(folder_, small);
  const double c = std::sqrt(0.5);
  map.add(TestFrame({c, c, 0, 0, c, -c, 0, 0, 0, 0, -1, 2}, {}, 0, 1).frame);
  const std::vector<MapBox> tiles = map.tile_boxes();
  EXPECT_GT(tiles.size(), 100U);
  for (const MapBox& tile : tiles) {
    const MapRaster raster = map.read(tile);
    EXPECT_TRUE(std::any_of(raster.views.row(0), raster.views.row(0) + raster.views.pixels(),
                            [](auto views) { return views > 0; }));
  }
}

// Damage a long way apart, in cells finer than a pixel; what lies between costs nothing.
TEST_F(RoadMapTest, FindsDamageInFineCellsFarApart) {
  const Step step{0.1, 0.05, 0.25, 0.05};
  RoadMapOptions fine = options();
  fine.cell_m = 0.004;
  RoadMap map(folder_, fine);
  constexpr double far = 50'000;
  for (const double x : {0.0, far}) {
    const Step there{x + step.x, x + step.y, step.radius_m, step.depth_m};
    map.add(TestFrame(looking_down(x, x, 2), there, 0.02, 1).frame);
  }
  const std::vector<MapDamage> found = find_map_damage(map, {});
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(found[k].at_m[0] - (k == 0 ? 0 : far), step.x, 0.02);
    EXPECT_NEAR(found[k].at_m[1] - (k == 0 ? 0 : far), step.y, 0.02);
    EXPECT_NEAR(found[k].damage.metrics->max_depth_m.value, step.depth_m, 0.005);
  }
}

}  // namespace
}  // namespace roadstereo
