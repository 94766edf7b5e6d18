// Rejection of disparities beside the road on the device against reject_off_road of the host.

#include <cmath>

#include "road/off_road/cuda/off_road.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/road/cell_maps.hpp"
#include "tests/road/coarse_scene.hpp"

namespace roadstereo {
namespace {

class CudaOffRoad : public test::OnDevice {};

/// Returns the number of invalid pixels.
int expect_same_invalid(const Image<float>& found, const Image<float>& error, const Image<float>& expected,
                        const Image<float>& expected_error) {
  int invalid = 0;
  for (int v = 0; v < found.height(); ++v) {
    for (int u = 0; u < found.width(); ++u) {
      EXPECT_EQ(std::isnan(found(u, v)), std::isnan(expected(u, v))) << u << ", " << v;
      EXPECT_EQ(std::isnan(error(u, v)), std::isnan(expected_error(u, v))) << u << ", " << v;
      invalid += std::isnan(found(u, v)) ? 1 : 0;
    }
  }
  return invalid;
}

/// Returns the number of pixels that are rejected.
int expect_as_on_host(const test::CellMaps& maps) {
  test::CellMaps expected = maps;
  reject_off_road(expected.correlation, {1.0}, 1, expected.disparity, expected.sigma);
  const test::DevicePlane<float> correlation(maps.correlation), disparity(maps.disparity), sigma(maps.sigma);
  cuda::OffRoad off_road;
  off_road.run(correlation.view(), 1.0F, disparity.plane(), sigma.plane(), nullptr);
  return expect_same_invalid(disparity.on_host(), sigma.on_host(), expected.disparity, expected.sigma);
}

/// Likewise, of the check with a coarse map.
int expect_consistency_as_on_host(const test::StreetMaps& maps) {
  test::StreetMaps expected = maps;
  reject_inconsistent(maps.coarse.view(), maps.shift, 1, expected.disparity, expected.sigma);
  const test::DevicePlane<float> coarse(maps.coarse.disparity), disparity(maps.disparity), sigma(maps.sigma);
  cuda::OffRoad off_road;
  off_road.run({coarse.view(), maps.coarse.factor, maps.shift}, disparity.plane(), sigma.plane(), nullptr);
  return expect_same_invalid(disparity.on_host(), sigma.on_host(), expected.disparity, expected.sigma);
}

TEST_F(CudaOffRoad, FollowsCorridorAsHost) {
  EXPECT_GT(expect_as_on_host(test::maze(317, 203)), 0);
  EXPECT_GT(expect_as_on_host(test::maze(640, 97)), 0);
}

TEST_F(CudaOffRoad, ConfirmedMapStays) {
  test::CellMaps maps(133, 70);
  maps.fill(0.1F, 0.9F);
  EXPECT_EQ(expect_as_on_host(maps), 0);
}

/// A vehicle that reaches above the horizon, one that the road encloses, and a house at the border.
TEST_F(CudaOffRoad, ChecksConsistencyAsHost) {
  for (const int factor : {4, 8}) {
    test::StreetMaps street(413, 241, factor);
    EXPECT_EQ(expect_consistency_as_on_host(street), 0);
    street.paint_coarse({30, 20, 50, 40}, 20);
    street.paint_coarse({60, 40, 80, 50}, 20);
    street.paint_coarse({0, 0, 20, 45}, -6);
    EXPECT_GT(expect_consistency_as_on_host(street), 0);
  }
}

}  // namespace
}  // namespace roadstereo
