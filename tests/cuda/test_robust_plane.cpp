// The robust plane fit on the device against the host's, and against planes that are known.

#include <gtest/gtest.h>

#include <cmath>

#include "road/cuda/robust_plane.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/error.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo::cuda {
namespace {

constexpr DisparityPlane road{4, 0.11, -0.02};

struct Points {
  std::vector<float> u, v, d;

  void add(double at_u, double at_v, double disparity) {
    u.push_back(static_cast<float>(at_u));
    v.push_back(static_cast<float>(at_v));
    d.push_back(static_cast<float>(disparity));
  }
  std::vector<DisparityPoint> present() const {
    std::vector<DisparityPoint> points;
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (!std::isnan(d[i])) points.push_back({u[i], v[i], d[i]});
    }
    return points;
  }
};

/// A noisy road with a quarter of outliers, every tenth point missing.
Points noisy_road(int count, double noise) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double u = std::floor(640 * test::lattice(i, 1, 3)), v = std::floor(360 * test::lattice(i, 2, 3));
    double d = road.disparity(u, v) + noise * (test::lattice(i, 3, 3) + test::lattice(i, 4, 3) - 1);
    if (test::lattice(i, 5, 3) < 0.25) d += 6 * test::lattice(i, 6, 3) - 1;
    points.add(u, v, i % 10 == 0 ? NAN : d);
  }
  return points;
}

struct Fitted {
  FittedPlane plane;
  std::vector<float> weights;
};

Fitted fit_on_device(const Points& points, const DisparityPlane& start, const RobustFit& how,
                     bool start_in_memory = false) {
  const auto u = test::to_device(points.u), v = test::to_device(points.v), d = test::to_device(points.d);
  const DisparityPlane plane{start.a0, start.a1, start.a2};
  const auto memory = test::to_device(std::vector{plane});
  RobustPlaneFit fit;
  fit.run({u.data(), v.data(), d.data(), static_cast<int>(points.u.size())},
          {start_in_memory ? memory.data() : nullptr, start_in_memory ? DisparityPlane{} : plane}, how, nullptr);
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  EXPECT_EQ(test::to_host(fit.plane(), 1).front().plane.a0, fit.result().plane.a0);
  return {fit.result(), test::to_host(fit.weights(), points.u.size())};
}

void expect_agreement(const Fitted& device, const IrlsPlaneFit& host, const Points& points) {
  ASSERT_EQ(device.plane.found, 1);
  EXPECT_LE(std::abs(device.plane.iterations - host.iterations), 1);
  // The last step is at most a fiftieth of a standard error, at the corners a tenth.
  const bool same_steps = test::kernels_round_as_host || device.plane.iterations == host.iterations;
  const double last_step = 0.1 / std::sqrt(static_cast<double>(device.plane.points));
  for (const double v : {0.0, 359.0}) {
    for (const double u : {0.0, 639.0}) {
      EXPECT_NEAR(device.plane.plane.disparity(u, v), host.plane.disparity(u, v),
                  same_steps ? 2e-6 : last_step * host.scale_px);
    }
  }
  EXPECT_NEAR(device.plane.scale_px, host.scale_px, (same_steps ? 1e-5 : last_step) * host.scale_px);
  std::size_t present = 0;
  for (std::size_t i = 0; i < points.d.size(); ++i) {
    if (std::isnan(points.d[i])) {
      EXPECT_EQ(device.weights[i], 0);
    } else {
      EXPECT_NEAR(device.weights[i], host.weights[present++], same_steps ? 1e-4 : last_step);
    }
  }
  EXPECT_EQ(device.plane.points, static_cast<int>(present));
}

class CudaRobustPlane : public test::OnDevice {};

TEST_F(CudaRobustPlane, MatchesHost) {
  const DisparityPlane start{4.4, 0.109, -0.0195};
  // A thread has eight points, a block at least 128 threads.
  for (const int count : {37, 500, 1024, 1025, 1800, max_fit_points}) {
    for (const double noise : {0.5, 0.0}) {
      SCOPED_TRACE(testing::Message() << count << " points, noise " << noise);
      const Points points = noisy_road(count, noise);
      const auto host = fit_plane_irls(points.present(), start, 0.5, true, 50);
      ASSERT_TRUE(host);
      expect_agreement(fit_on_device(points, start, {0.5, true, 50}, count == 500), *host, points);
      EXPECT_NEAR(host->plane.disparity(320, 180), road.disparity(320, 180), 0.2);
    }
  }
}

TEST_F(CudaRobustPlane, WithoutRollIgnoresRollOfStart) {
  const Points points = noisy_road(400, 0.5);
  const DisparityPlane start{4, 0.11, -0.01};
  const auto host = fit_plane_irls(points.present(), start, 2, false, 50);
  ASSERT_TRUE(host);
  const Fitted device = fit_on_device(points, start, {2, false, 50});
  expect_agreement(device, *host, points);
  EXPECT_EQ(device.plane.plane.a2, 0);
}

TEST_F(CudaRobustPlane, StopsAfterMaximumSteps) {
  const Points points = noisy_road(300, 0.5);
  const auto host = fit_plane_irls(points.present(), {4.4, 0.109, -0.02}, 0.5, true, 3);
  const Fitted device = fit_on_device(points, {4.4, 0.109, -0.02}, {0.5, true, 3});
  EXPECT_EQ(device.plane.iterations, host->iterations);
  EXPECT_NEAR(device.plane.plane.a0, host->plane.a0, 1e-6);
}

TEST_F(CudaRobustPlane, TooFewPointsGiveNoPlane) {
  Points line;
  for (int i = 0; i < 50; ++i) line.add(2 * i, 3 * i, i);
  EXPECT_EQ(fit_on_device(line, {0, 1.0 / 3, 0}, {0.5, true, 50}).plane.found, 0);
  EXPECT_EQ(fit_on_device(line, {0, 1.0 / 3, 0}, {0.5, false, 50}).plane.found, 1);
  Points far = noisy_road(100, 0.5);
  EXPECT_EQ(fit_on_device(far, {400, 0, 0}, {0.5, true, 50}).plane.found, 0);
  const Points none{{1, 2, 3}, {4, 5, 7}, {NAN, 2, 3}};
  EXPECT_EQ(fit_on_device(none, road, {0.5, true, 50}).plane.found, 0);
  Points many = noisy_road(max_fit_points + 1, 0.5);
  EXPECT_THROW(fit_on_device(many, road, {0.5, true, 50}), Error);
}

}  // namespace
}  // namespace roadstereo::cuda
