// How frames are put together in a map: whatever the number of threads, colours, and what each option changes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/road_map.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

/// A map in a folder of its own, with cells of 1 cm.
RoadMap map_with(const RoadMapOptions& options) {
  static int count = 0;
  return {std::filesystem::temp_directory_path() /
              ("roadstereo_fusion_" + std::to_string(::getpid()) + "_" + std::to_string(++count)),
          options};
}

RoadMapOptions fusion_options() {
  RoadMapOptions options;
  options.cell_m = 0.01;
  options.tile_cells = 32;
  options.threads = 1;
  return options;
}

/// The cell around the origin.
struct OneCell {
  float height = NAN, sigma = NAN;
  std::array<std::uint8_t, 3> colour{};
  std::uint16_t views = 0;

  explicit OneCell(const RoadMap& map) {
    const MapRaster raster = map.read({0, 0, 1, 1});
    height = raster.height(0, 0);
    sigma = raster.sigma(0, 0);
    colour = raster.colour(0, 0);
    views = raster.views(0, 0);
  }
};

/// A level road `depth_m` below z = 0 as seen from 2 m above it.
TestFrame level_frame(double depth_m, float sigma_px) {
  constexpr double everywhere_m = 100;
  TestFrame view(looking_down(0, 0, 2), Step{0, 0, everywhere_m, depth_m}, 0, 1);
  view.sigma.assign(width, height, sigma_px);
  view.frame.sigma = view.sigma;
  return view;
}

TEST(RoadMapFusion, IsIndependentOfThreads) {
  std::array<MapRaster, 2> rasters;
  std::array<SavedMap, 2> saved;
  for (const std::size_t k : {0, 1}) {
    RoadMapOptions options = fusion_options();
    options.threads = k == 0 ? 1 : 3;
    RoadMap map = map_with(options);
    for (int i = 0; i < 9; ++i) {
      TestFrame view(looking_down(0.02 * i, 0.013 * i, 2), Step{0.1, 0, 0.2, 0.05}, 0.05, static_cast<unsigned>(i + 1));
      for (std::size_t p = 0; p < view.grey.size(); ++p)
        view.grey[p] = static_cast<std::uint8_t>(p * 37 + p / 160 * 11);
      map.add(view.frame);
    }
    rasters[k] = map.read(map.bounds());
    saved[k] = map.save();
  }
  const auto& [one, other] = rasters;
  ASSERT_GT(one.height.pixels(), 40'000U);
  EXPECT_EQ(one.views, other.views);
  EXPECT_EQ(one.colour, other.colour);
  std::size_t measured = 0;
  for (std::size_t k = 0; k < one.height.pixels(); ++k) {
    if (one.views.row(0)[k] == 0) {
      ASSERT_TRUE(std::isnan(one.height.row(0)[k]) && std::isnan(other.height.row(0)[k])) << k;
      continue;
    }
    ++measured;
    ASSERT_EQ(one.height.row(0)[k], other.height.row(0)[k]) << k;
    ASSERT_EQ(one.sigma.row(0)[k], other.sigma.row(0)[k]) << k;
  }
  EXPECT_GT(measured, 20'000U);
  EXPECT_GT(saved[0].sums[2], 10'000) << "the errors of heights were measured";
  EXPECT_EQ(saved[0].sums, saved[1].sums);
  EXPECT_EQ(saved[0].tiles, saved[1].tiles);
}

TEST(RoadMapFusion, ColourIsRedGreenBlue) {
  RoadMap map = map_with(fusion_options());
  TestFrame view = level_frame(0, 0.1F);
  std::vector<std::uint8_t> bgr;
  for (int k = 0; k < width * height; ++k) bgr.insert(bgr.end(), {10, 100, 200});
  view.frame.image = FrameView::bgr8(bgr.data(), width, height);
  map.add(view.frame);
  const MapBox bounds = map.bounds();
  const MapRaster raster = map.read({bounds.i0 - 5, bounds.j0 - 5, bounds.columns + 10, bounds.rows + 10});
  std::size_t measured = 0;
  for (std::size_t k = 0; k < raster.views.pixels(); ++k) {
    const bool seen = raster.views.row(0)[k] > 0;
    measured += seen ? 1 : 0;
    const std::array<std::uint8_t, 3> expected =
        seen ? std::array<std::uint8_t, 3>{200, 100, 10} : std::array<std::uint8_t, 3>{0, 0, 0};
    ASSERT_EQ(raster.colour.row(0)[k], expected) << k;
  }
  EXPECT_GT(measured, 20'000U);
  EXPECT_LT(measured, raster.views.pixels());
}

// Straight down, a pixel covers (Z/f)² of the road: 2 m count four times as much as 4 m, in either order.
TEST(RoadMapFusion, ColourCountsByTheInverseAreaOfAPixel) {
  for (const bool near_first : {true, false}) {
    RoadMap map = map_with(fusion_options());
    for (const bool is_near : {near_first, !near_first}) {
      TestFrame view(looking_down(0, 0, is_near ? 2 : 4), {}, 0, 1);
      view.grey.assign(view.grey.size(), is_near ? 100 : 200);
      view.frame.image = FrameView::grey8(view.grey.data(), width, height);
      map.add(view.frame);
    }
    const OneCell cell(map);
    EXPECT_EQ(cell.views, 2);
    for (const std::uint8_t channel : cell.colour) EXPECT_EQ(channel, 120) << near_first;
  }
}

// 0.06 px are 10 mm at 2 m, where d = 12 px. Two heights 50 mm apart differ by 50/√(10² + 10.5²) = 3.4 standard errors.
TEST(RoadMapFusion, GateDividesSurfaces) {
  for (const double gate : {3.0, 4.0}) {
    RoadMapOptions options = fusion_options();
    options.gate_sigmas = gate;
    RoadMap map = map_with(options);
    map.add(level_frame(0, 0.06F).frame);
    map.add(level_frame(0.05, 0.06F).frame);
    const OneCell cell(map);
    EXPECT_EQ(cell.views, gate == 3 ? 1 : 2);
    EXPECT_NEAR(cell.height, gate == 3 ? 0 : -0.05 / (1 + 1.025 * 1.025 * 1.025 * 1.025), 2e-4);
  }
}

// A block 0.3 m high, and a hole as deep, around the origin.
TEST(RoadMapFusion, LimitsAboveAndBelowRoadLeaveOut) {
  for (const bool above : {true, false}) {
    for (const double limit_m : {0.31, 0.29}) {
      RoadMapOptions options = fusion_options();
      (above ? options.max_above_m : options.max_below_m) = limit_m;
      RoadMap map = map_with(options);
      map.add(TestFrame(looking_down(0, 0, 2), Step{0, 0, 0.3, above ? -0.3 : 0.3}, 0, 1).frame);
      const OneCell cell(map);
      EXPECT_EQ(cell.views, limit_m > 0.3 ? 1 : 0) << above;
      EXPECT_EQ(std::isnan(cell.height), limit_m < 0.3) << above;
      if (limit_m > 0.3) {
        EXPECT_NEAR(cell.height, above ? 0.3 : -0.3, 1e-4);
      }
      EXPECT_EQ(map.read({-60, 0, 1, 1}).views(0, 0), 1) << "the road beside it";
    }
  }
}

// Z²/(f·h) = 2/120 m along the line of sight: 1.67 cells.
TEST(RoadMapFusion, PixelsThatCoverTooManyCellsAreLeftOut) {
  for (const double limit : {1.7, 1.6}) {
    RoadMapOptions options = fusion_options();
    options.max_footprint_cells = limit;
    RoadMap map = map_with(options);
    EXPECT_EQ(map.add(level_frame(0, 0.1F).frame) > 10'000, limit > 1.6) << limit;
    EXPECT_EQ(map.bounds().empty(), limit < 1.7) << limit;
  }
}

// Of two heights without spread, the variance is that of one if all of it is common, and linear in the share.
TEST(RoadMapFusion, CommonShareOfVarianceDoesNotShrink) {
  std::array<double, 3> variances{};
  for (const std::size_t k : {0, 1, 2}) {
    RoadMapOptions options = fusion_options();
    options.common_share = 0.5 * static_cast<double>(k);
    RoadMap map = map_with(options);
    for (int i = 0; i < 2; ++i) map.add(level_frame(0, 0.06F).frame);
    const OneCell cell(map);
    ASSERT_EQ(cell.views, 2);
    variances[k] = double{cell.sigma} * double{cell.sigma};
  }
  EXPECT_NEAR(variances[2], 0.01 * 0.01, 1e-7);
  EXPECT_NEAR(variances[1], (variances[0] + variances[2]) / 2, 1e-9);
  EXPECT_LT(variances[0], 0.8 * variances[2]);
  EXPECT_GE(variances[0], 0.499 * variances[2]) << "that of two independent ones";
}

}  // namespace
}  // namespace roadstereo
