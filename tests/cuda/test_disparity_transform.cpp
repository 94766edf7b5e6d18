// The transformed map on the device: the host's, bit for bit, and its spread.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "road/cuda/disparity_transform.hpp"
#include "roadstereo/roll.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"
#if defined(ROADSTEREO_CUDA_EMULATED)
#include <stdexcept>

#include "tests/cuda/emulated/run_kernel.hpp"
#endif

namespace roadstereo::cuda {
namespace {

constexpr DisparityPlane road{7.3, 0.11, -0.023};

/// A noisy road with a hole, a vehicle and missing pixels.
Image<float> damaged_road(int width, int height) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double d = road.disparity(u, v) + 0.3 * (test::lattice(u, v, 4) + test::lattice(u, v, 5) - 1);
      if (std::hypot(u - 0.6 * width, v - 0.5 * height) < 0.1 * width) d -= 2.4;
      if (u < width / 5 && v < height / 3) d += 11;
      map(u, v) = test::lattice(u, v, 6) < 0.1 ? NAN : static_cast<float>(d);
    }
  }
  return map;
}

class CudaDisparityTransform : public test::OnDevice {
 protected:
  void expect_agreement(const Image<float>& map, const DisparityPlane& plane, double given, double least) {
    RollEstimate geometry;
    geometry.plane = plane;
    RollOptions options;
    options.delta_t_px = given;
    Image<float> expected;
    const double delta_t = transform_disparity(map, geometry, least, options, 1, expected);
    const RoadResiduals spread = measure_residuals(expected, delta_t, 1);
    const test::DevicePlane<float> disparity(map.view()), transformed(map.width(), map.height());
    const auto in_memory = test::to_device(std::vector{DisparityPlane{plane.a0, plane.a1, plane.a2}});
    transform_->run(disparity.view(), {in_memory.data(), {}}, {given, least}, transformed.plane(), nullptr);
    ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
    const Image<float> found = transformed.on_host();
    int differ = 0, valid = 0;
    for (int v = 0; v < map.height(); ++v) {
      for (int u = 0; u < map.width(); ++u) {
        const float a = found(u, v), b = expected(u, v);
        differ += a == b || (std::isnan(a) && std::isnan(b)) ? 0 : 1;
        valid += std::isnan(map(u, v)) ? 0 : 1;
      }
    }
    EXPECT_EQ(differ, 0);
    const TransformStatistics& statistics = transform_->statistics();
    EXPECT_EQ(statistics.delta_t, delta_t);
    EXPECT_EQ(statistics.valid, valid);
    EXPECT_NEAR(statistics.sigma_road_px, spread.sigma_road_px, 1e-6 * spread.sigma_road_px);
    EXPECT_NEAR(statistics.sigma_all_px, spread.sigma_all_px, 1e-6 * spread.sigma_all_px);
    EXPECT_NEAR(statistics.road_share, spread.road_share, 1e-9);
  }

  test::MadeOnUse<DisparityTransform> transform_;  ///< used again for maps of every size
};

TEST_F(CudaDisparityTransform, MatchesHost) {
  for (const auto& [width, height] : {std::pair(33, 35), std::pair(129, 47), std::pair(201, 91)}) {
    SCOPED_TRACE(testing::Message() << width << "×" << height);
    const Image<float> map = damaged_road(width, height);
    expect_agreement(map, road, -1, 2);
    expect_agreement(map, {road.a0 + 0.7, road.a1, road.a2}, -1, 7.4);
  }
}

TEST_F(CudaDisparityTransform, AppliesGivenOffset) {
  expect_agreement(damaged_road(129, 47), road, 30, 2);
  expect_agreement(damaged_road(129, 47), road, 12.3, 2);
}

TEST_F(CudaDisparityTransform, LimitGrowsWithNoise) {
  Image<float> map = damaged_road(129, 47);
  for (int v = 0; v < 47; ++v) {
    for (int u = 0; u < 129; ++u) map(u, v) += static_cast<float>(4 * test::lattice(u, v, 9) - 2);
  }
  expect_agreement(map, road, -1, 2);
  EXPECT_GT(transform_->statistics().sigma_road_px, 1);
}

TEST_F(CudaDisparityTransform, EmptyMapStaysEmpty) {
  const Image<float> none(40, 30, std::numeric_limits<float>::quiet_NaN());
  expect_agreement(none, road, -1, 3);
  EXPECT_EQ(transform_->statistics().delta_t, 3);
  EXPECT_EQ(transform_->statistics().valid, 0);
  expect_agreement(damaged_road(33, 35), road, -1, 2);  // and leaves nothing behind
}

#if defined(ROADSTEREO_CUDA_EMULATED)
TEST_F(CudaDisparityTransform, FailedLaunchLeavesNothingBehind) {
  const Image<float> map = damaged_road(129, 47);
  const test::DevicePlane<float> disparity(map.view()), transformed(129, 47);
  for (const int launches : {0, 1}) {
    emulated::fail_after(launches);
    EXPECT_THROW(transform_->run(disparity.view(), {nullptr, road}, {-1, 2}, transformed.plane(), nullptr),
                 std::runtime_error);
    expect_agreement(map, road, -1, 2);
  }
}
#endif

TEST_F(CudaDisparityTransform, ExactRoadIsFlat) {
  Image<float> map(64, 48);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) map(u, v) = static_cast<float>(10 + 0.25 * v - 0.125 * u);
  }
  map(30, 20) -= 2;
  const test::DevicePlane<float> disparity(map.view()), transformed(64, 48);
  transform_->run(disparity.view(), {nullptr, {10, 0.25, -0.125}}, {-1, 1}, transformed.plane(), nullptr);
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  const Image<float> found = transformed.on_host();
  EXPECT_EQ(transform_->statistics().delta_t, 3);
  EXPECT_EQ(found(30, 20), 1);
  EXPECT_EQ(found(31, 20), 3);
  EXPECT_EQ(found(0, 0), 3);
  EXPECT_EQ(transform_->statistics().sigma_road_px, 0);
  EXPECT_NEAR(transform_->statistics().road_share, 1 - 1.0 / (64 * 48), 1e-12);
}

}  // namespace
}  // namespace roadstereo::cuda
