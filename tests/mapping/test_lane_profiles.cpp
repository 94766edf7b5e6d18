// Profiles of a lane whose heights are a closed form: an inclined section with a rut along the path.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "roadstereo/road_profile.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

constexpr double lane_length_m = 30, lane_cell_m = 0.05;
constexpr double lane_slope = -0.03, lane_rut_m = 0.012, lane_rut_width_m = 0.8;

struct RuttedLane {
  double height(double x, double /*y*/) const {
    const double across = 2 * x / lane_rut_width_m;
    return lane_slope * x - lane_rut_m * std::max(0.0, 1 - across * across);
  }
};

struct Hole {
  double begin_m, end_m;  ///< y
};
/// In the middle of the lane, where no wheel runs.
constexpr Hole small_hole{5, 5.2}, large_hole{14, 14.4};

/// Map of the lane along y from a camera 6 m above it, whose pixels are as large as the cells.
RoadMap lane_map() {
  RoadMapOptions options;
  options.cell_m = lane_cell_m;
  options.threads = 1;
  RoadMap map(std::filesystem::temp_directory_path() / ("roadstereo_lane_" + std::to_string(::getpid())), options);
  constexpr double up_m = 6, step_m = 4;
  for (double y = 2; y < lane_length_m + step_m; y += step_m) {
    TestFrame view(looking_down(0, y, up_m), RuttedLane(), 0, 1);
    view.sigma.assign(width, height, 1e-4F);
    view.frame.sigma = view.sigma;
    const StereoCalibration& camera = view.frame.calibration;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const auto p = camera.point_m(u, v, view.disparity(u, v));
        for (const Hole& hole : {small_hole, large_hole}) {
          if (std::abs(p[0]) > 0.2 || y - p[1] < hole.begin_m || y - p[1] > hole.end_m) continue;
          view.disparity(u, v) = std::numeric_limits<float>::quiet_NaN();
        }
      }
    }
    map.add(view.frame);
  }
  return map;
}

/// From the middle of the first cell to that of the last one, or back.
std::vector<std::array<double, 2>> lane_path(bool backwards) {
  constexpr double first_m = lane_cell_m / 2, end_m = lane_length_m - lane_cell_m / 4;
  std::vector<std::array<double, 2>> path;
  for (double y = first_m; y < end_m; y += 0.5) path.push_back({0, y});
  path.push_back({0, end_m});
  for (auto& point : path) {
    if (backwards) point[1] = lane_length_m - point[1];
  }
  return path;
}

LaneProfiles lane_profiles(bool backwards) {
  LaneOptions options;
  options.section_m = 12;
  return measure_lane(lane_map(), lane_path(backwards), options);
}

TEST(MeasureLane, CrossSlopeAndRut) {
  for (const bool backwards : {false, true}) {
    SCOPED_TRACE(backwards);
    const LaneProfiles lane = lane_profiles(backwards);
    ASSERT_EQ(lane.transverse.size(), 60U);
    std::size_t whole = 0;
    for (std::size_t k = 0; k < lane.transverse.size(); ++k) {
      const TransverseProfile& profile = lane.transverse[k];
      EXPECT_NEAR(profile.station_m, 0.5 * static_cast<double>(k), 1e-9);
      const double y = backwards ? lane_length_m - 0.025 - profile.station_m : 0.025 + profile.station_m;
      EXPECT_NEAR(profile.at_m[0], 0, 1e-9);
      EXPECT_NEAR(profile.at_m[1], y, 1e-9);
      EXPECT_NEAR(profile.heading_rad, (backwards ? -1 : 1) * std::numbers::pi / 2, 1e-9);
      const auto near = [y](const Hole& hole) { return y > hole.begin_m - 0.3 && y < hole.end_m + 0.3; };
      if (near(small_hole) || near(large_hole)) continue;
      ++whole;
      // Positive where the right is lower: to the right of the way there, and to the left of the way back.
      EXPECT_NEAR(profile.cross_slope.value, (backwards ? 1 : -1) * lane_slope, 1e-4) << y;
      EXPECT_GT(profile.cross_slope.std_error, 0) << y;
      // Its lowest height is the mean of two cells whose middles are 2.5 cm beside the bottom.
      constexpr double beside = 2 * 0.025 / lane_rut_width_m;
      EXPECT_NEAR(profile.rut_depth_m.value, lane_rut_m * (1 - beside * beside), 1e-4) << y;
      EXPECT_TRUE(profile.rut_resolvable) << y;
      EXPECT_NEAR(profile.width_m, 3.1, 1e-9) << "31 strips of 0.1 m";
    }
    EXPECT_GE(whole, 56U);
  }
}

TEST(MeasureLane, HeightsAlongWheelPaths) {
  for (const bool backwards : {false, true}) {
    SCOPED_TRACE(backwards);
    const LaneProfiles lane = lane_profiles(backwards);
    EXPECT_EQ(lane.spacing_m, lane_cell_m);
    ASSERT_EQ(lane.longitudinal.size(), 3U * 600U);
    std::size_t missing = 0;
    for (const LongitudinalPoint& point : lane.longitudinal) {
      const double x = (backwards ? -1 : 1) * point.offset_m;
      EXPECT_NEAR(point.at_m[0], x, 1e-9);
      if (std::isnan(point.height_m)) {
        ++missing;
        EXPECT_EQ(point.offset_m, 0);
        continue;
      }
      // The mean of the cells 2.5 cm to the left and to the right.
      const double expected = (RuttedLane().height(x - 0.025, 0) + RuttedLane().height(x + 0.025, 0)) / 2;
      ASSERT_NEAR(point.height_m, expected, 1e-4) << point.offset_m << ", " << point.station_m;
    }
    EXPECT_EQ(missing, 4U + 8U) << "holes of 0.2 m and 0.4 m";
  }
}

/// Expects one section, as even as the road is.
void expect_section(const RoughnessSection& section, double offset_m, double start_m, double length_m) {
  EXPECT_EQ(section.offset_m, offset_m);
  EXPECT_NEAR(section.start_m, start_m, 1e-9);
  EXPECT_NEAR(section.length_m, length_m, 1e-9);
  EXPECT_LT(section.index_m_km, 0.05);
}

// The small hole is interpolated, the large one ends a section. What is left is divided into equal parts.
TEST(MeasureLane, SectionsBetweenHoles) {
  for (const bool backwards : {false, true}) {
    SCOPED_TRACE(backwards);
    const LaneProfiles lane = lane_profiles(backwards);
    ASSERT_EQ(lane.sections.size(), 6U);
    const double first_m = backwards ? lane_length_m - large_hole.end_m : large_hole.begin_m;
    const double hole_m = large_hole.end_m - large_hole.begin_m;
    expect_section(lane.sections[0], -0.75, 0, 15);
    expect_section(lane.sections[1], -0.75, 15, 15);
    expect_section(lane.sections[2], 0, 0, first_m);
    expect_section(lane.sections[3], 0, first_m + hole_m, lane_length_m - first_m - hole_m);
    expect_section(lane.sections[4], 0.75, 0, 15);
    expect_section(lane.sections[5], 0.75, 15, 15);
  }
}

// With a limit below the small hole, both end sections, and 5 m are too short for an index.
TEST(MeasureLane, GapsUpToTheLimitAreInterpolated) {
  LaneOptions options;
  options.section_m = 12;
  options.max_gap_m = 0.15;
  std::vector<RoughnessSection> middle;
  for (const RoughnessSection& section : measure_lane(lane_map(), lane_path(false), options).sections) {
    if (section.offset_m == 0) middle.push_back(section);
  }
  ASSERT_EQ(middle.size(), 1U);
  expect_section(middle[0], 0, large_hole.end_m, lane_length_m - large_hole.end_m);
  options.max_gap_m = 0.5;
  middle.clear();
  for (const RoughnessSection& section : measure_lane(lane_map(), lane_path(false), options).sections) {
    if (section.offset_m == 0) middle.push_back(section);
  }
  ASSERT_EQ(middle.size(), 2U);
  expect_section(middle[0], 0, 0, 15);
  expect_section(middle[1], 0, 15, 15);
}

}  // namespace
}  // namespace roadstereo
