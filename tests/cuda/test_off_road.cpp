// Rejection of disparities beside the road on the device against reject_off_road of the host.

#include <cmath>

#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/off_road/cuda/off_road.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/road/street_maps.hpp"

namespace roadstereo {
namespace {

class CudaOffRoad : public test::OnDevice {};

/// Returns the number of pixels that are rejected.
int expect_as_on_host(const test::StreetMaps& maps) {
  test::StreetMaps expected = maps;
  reject_off_road(maps.correlation, maps.scene.view(), maps.shift, {}, {1.0}, 1, expected.disparity, expected.sigma);
  const test::DevicePlane<float> scene(maps.scene.disparity), correlation(maps.correlation), disparity(maps.disparity),
      sigma(maps.sigma);
  cuda::OffRoad off_road;
  off_road.run({scene.view(), maps.scene.factor, maps.shift}, correlation.view(), 1.0F, disparity.plane(),
               sigma.plane(), nullptr);
  const Image<float> found = disparity.on_host(), error = sigma.on_host();
  int rejected = 0, differ = 0;
  for (int v = 0; v < found.height(); ++v) {
    for (int u = 0; u < found.width(); ++u) {
      const bool same = std::isnan(found(u, v)) == std::isnan(expected.disparity(u, v)) &&
                        std::isnan(error(u, v)) == std::isnan(expected.sigma(u, v));
      differ += same ? 0 : 1;
      rejected += std::isnan(found(u, v)) && !std::isnan(maps.disparity(u, v)) ? 1 : 0;
    }
  }
  // What lies at the edge of a threshold is a cell.
  EXPECT_LE(differ, test::kernels_round_as_host ? 0 : 2 * alignment_cell * alignment_cell);
  return rejected;
}

TEST_F(CudaOffRoad, FollowsCorridorAsHost) {
  EXPECT_GT(expect_as_on_host(test::Maze(413, 331).maps), 0);
  EXPECT_GT(expect_as_on_host(test::Maze(641, 402).maps), 0);
}

/// A vehicle that reaches above the horizon, one that the road encloses, and a house at the border, in weak texture.
TEST_F(CudaOffRoad, AssessesCellsAsHost) {
  for (const int factor : {4, 8}) {
    test::StreetMaps street(413, 241, factor);
    street.paint_scene({30, 20, 50, 40}, 20);
    street.paint_scene({60, 40, 80, 50}, 20);
    street.paint_scene({0, 0, 20, 45}, -6);
    street.paint_sigma({10, 5, 70, 30}, 1.5F, 0.4F);
    EXPECT_GT(expect_as_on_host(street), 0);
  }
}

TEST_F(CudaOffRoad, RoadStays) {
  EXPECT_EQ(expect_as_on_host(test::StreetMaps(133, 140, 4)), 0);
}

}  // namespace
}  // namespace roadstereo
