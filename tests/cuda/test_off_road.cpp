// Rejection of disparities beside the road on the device against reject_off_road of the host.

#include <cmath>

#include "road/off_road/cuda/off_road.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/road/cell_maps.hpp"

namespace roadstereo {
namespace {

class CudaOffRoad : public test::OnDevice {};

/// Returns the number of pixels that are rejected.
int expect_as_on_host(const test::CellMaps& maps) {
  test::CellMaps expected = maps;
  reject_off_road(expected.correlation, {1.0}, 1, expected.disparity, expected.sigma);
  const test::DevicePlane<float> correlation(maps.correlation), disparity(maps.disparity), sigma(maps.sigma);
  cuda::OffRoad off_road;
  off_road.run(correlation.view(), 1.0F, disparity.plane(), sigma.plane(), nullptr);
  const Image<float> found = disparity.on_host(), error = sigma.on_host();
  int rejected = 0;
  for (int v = 0; v < found.height(); ++v) {
    for (int u = 0; u < found.width(); ++u) {
      EXPECT_EQ(std::isnan(found(u, v)), std::isnan(expected.disparity(u, v))) << u << ", " << v;
      EXPECT_EQ(std::isnan(error(u, v)), std::isnan(expected.sigma(u, v))) << u << ", " << v;
      rejected += std::isnan(found(u, v)) ? 1 : 0;
    }
  }
  return rejected;
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

}  // namespace
}  // namespace roadstereo
