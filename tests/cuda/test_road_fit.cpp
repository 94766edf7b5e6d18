// The road geometry on the device against estimate_roll(): all solvers, with damage, masks and too little to see.

#include <gtest/gtest.h>

#include <cmath>

#include "road/cuda/map_sums.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/cuda/roll_assessment.hpp"
#include "road/roll_assessment.hpp"
#include "roadstereo/error.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo::cuda {
namespace {

Image<float> road_map(int width, int height, double roll, double noise) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double d = 30 + 0.15 * (v * std::cos(roll) - u * std::sin(roll));
      d += noise * (test::smooth_noise(u, v, 6, 8) + test::lattice(u, v, 9) - 1);
      if (std::hypot(u - 0.7 * width, v - 0.6 * height) < 0.1 * width) d -= 4;
      const double chance = test::lattice(u, v, 11);
      if (chance < 0.05) d = 60 * test::lattice(u, v, 12);
      map(u, v) = chance > 0.9 ? NAN : static_cast<float>(d);
    }
  }
  return map;
}

Image<std::uint8_t> left_half(int width, int height) {
  Image<std::uint8_t> mask(width, height, 255);
  for (int v = 0; v < height; ++v) {
    for (int u = width / 2; u < width; ++u) mask(u, v) = 0;
  }
  return mask;
}

using Mask = std::optional<Image<std::uint8_t>>;

ImageView<const std::uint8_t> view_of(const Mask& mask) {
  return mask ? ImageView<const std::uint8_t>(mask->view()) : ImageView<const std::uint8_t>();
}

class CudaRoadFit : public test::OnDevice {
 protected:
  RollEstimate on_device(const Image<float>& map, const Mask& mask, const std::optional<DisparityPlane>& prior,
                         const RollOptions& options) {
    const int width = map.width(), height = map.height();
    const test::DevicePlane<float> disparity(map.view());
    std::optional<test::DevicePlane<std::uint8_t>> device_mask;
    if (mask) device_mask.emplace(mask->view());
    const MaskedMap masked{disparity.view(), mask ? device_mask->view() : ImageView<const std::uint8_t>{}};
    const auto wait = [this] {
      fit_->join(nullptr);
      ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
    };
    if (options.solver == RollSolver::robust) {
      const auto start = test::to_device(std::vector{DisparityPlane{prior->a0, prior->a1, prior->a2}});
      fit_->run(masked, {start.data(), {}}, options.max_iterations, nullptr);
      wait();
      return finish_road_fit(fit_->statistics(), width, height, options);
    }
    sums_->run(masked, roll_from_sums(0, options), nullptr);
    fit_->measure(masked, {sums_->plane(), {}}, nullptr);
    wait();
    return finish_solved(sums_->solved(), fit_->statistics(), width, height, options);
  }

  void expect_agreement(const Image<float>& map, const Mask& mask, const std::optional<DisparityPlane>& prior,
                        RollSolver solver) {
    RollOptions options;
    options.solver = solver;
    const RollEstimate device = on_device(map, mask, prior, options);
    const RollEstimate host = estimate_roll(map, view_of(mask), prior, 0, options, 1);
    EXPECT_LE(std::abs(device.iterations - host.iterations), 1);
    // The last step is at most a fiftieth of a standard error.
    const double looser = test::kernels_round_as_host || device.iterations == host.iterations ? 1 : 100;
    EXPECT_NEAR(device.roll_rad, host.roll_rad, looser * 1e-6);
    if (std::isfinite(host.roll_stderr_rad)) {
      EXPECT_NEAR(device.roll_stderr_rad, host.roll_stderr_rad, looser * 1e-4 * host.roll_stderr_rad);
    } else {
      EXPECT_EQ(device.roll_stderr_rad, host.roll_stderr_rad);
    }
    EXPECT_NEAR(device.residual_px, host.residual_px, looser * 1e-4 * host.residual_px);
    EXPECT_EQ(device.roll_observable, host.roll_observable);
    EXPECT_EQ(device.pixels, host.pixels);
    EXPECT_NEAR(device.alpha0, host.alpha0, looser * 1e-5);
    EXPECT_NEAR(device.alpha1, host.alpha1, looser * 1e-7);
    for (const double v : {0.0, map.height() - 1.0}) {
      for (const double u : {0.0, map.width() - 1.0}) {
        EXPECT_NEAR(device.plane.disparity(u, v), host.plane.disparity(u, v), looser * 1e-5);
      }
    }
    const DisparityPlane left = test::to_host(fit_->plane(), 1).front();
    EXPECT_EQ(left.a0, device.plane.a0);
    EXPECT_EQ(left.a2, device.plane.a2);
  }

  test::MadeOnUse<RoadFit> fit_;
  test::MadeOnUse<MapSums> sums_;
};

DisparityPlane prior_of(double roll) {
  return {30.2, 0.151 * std::cos(roll), -0.15 * std::sin(roll)};
}

TEST_F(CudaRoadFit, EverySolverMatchesHost) {
  for (const auto& [width, height] : {std::pair(33, 35), std::pair(129, 47), std::pair(161, 90)}) {
    for (const RollSolver solver : {RollSolver::robust, RollSolver::closed_form, RollSolver::gradient_descent}) {
      SCOPED_TRACE(testing::Message() << width << "×" << height << ", solver " << static_cast<int>(solver));
      expect_agreement(road_map(width, height, 0.12, 0.6), {}, prior_of(0.12), solver);
    }
  }
}

TEST_F(CudaRoadFit, IgnoresMaskedPixels) {
  const Image<float> map = road_map(129, 47, -0.05, 0.4);
  for (const RollSolver solver : {RollSolver::robust, RollSolver::closed_form}) {
    expect_agreement(map, left_half(129, 47), prior_of(-0.05), solver);
  }
}

TEST_F(CudaRoadFit, RecoversRollOfExactRoad) {
  Image<float> map(320, 180);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 320; ++u) {
      map(u, v) = static_cast<float>(20 + 0.15 * (v * std::cos(0.1) - u * std::sin(0.1)));
    }
  }
  const RollEstimate g = on_device(map, {}, DisparityPlane{20.4, 0.15, -0.0149}, {});
  EXPECT_NEAR(g.roll_rad, 0.1, 2e-6);
  EXPECT_NEAR(g.alpha0, 20, 1e-3);
  EXPECT_NEAR(g.alpha1, 0.15, 1e-5);
  EXPECT_TRUE(g.roll_observable);
}

TEST_F(CudaRoadFit, BadStartIsReplaced) {
  expect_agreement(road_map(129, 47, 0.02, 0.4), {}, DisparityPlane{400, 0, 0}, RollSolver::robust);
  EXPECT_EQ(fit_->statistics().fit.found, 1);
}

/// A pavement on the right, 1.4 px above the road. The fit starts from a plane that leans against the kerb.
TEST_F(CudaRoadFit, PavementIsNoRoad) {
  for (const int road_columns : {150, 110, 70}) {
    Image<float> map = road_map(160, 90, 0.02, 0.1);
    for (int v = 0; v < 90; ++v) {
      for (int u = road_columns; u < 160; ++u) map(u, v) += 1.4F;
    }
    const DisparityPlane leaning{30, 0.15 * std::cos(0.02), -0.15 * std::sin(0.02) + 1.4 / 160};
    expect_agreement(map, {}, leaning, RollSolver::robust);
  }
}

/// A house front fills half of the map.
TEST_F(CudaRoadFit, HouseFrontIsNoRoad) {
  Image<float> map = road_map(160, 90, 0.02, 0.1);
  for (int v = 0; v < 45; ++v) std::fill_n(map.row(v), 160, 29.0F);
  expect_agreement(map, {}, DisparityPlane{30, 0.15 * std::cos(0.02), -0.15 * std::sin(0.02)}, RollSolver::robust);
}

TEST_F(CudaRoadFit, RejectsLineLikeHost) {
  Image<float> map(100, 50, NAN);
  const auto said = [](const auto& fit) -> std::string {
    try {
      fit();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  for (int u = -1; u < 100; ++u) {
    if (u >= 0) map(u, 20) = 5;
    if (u != -1 && u != 12 && u != 99) continue;
    for (const RollSolver solver : {RollSolver::robust, RollSolver::closed_form}) {
      RollOptions options;
      options.solver = solver;
      const std::string device = said([&] { on_device(map, {}, DisparityPlane{5, 0, 0}, options); });
      EXPECT_EQ(device, said([&] { estimate_roll(map, {}, DisparityPlane{5, 0, 0}, 0, options, 1); }));
      EXPECT_NE(device, "nothing");
    }
  }
}

TEST_F(CudaRoadFit, SumsMatchClosedForm) {
  // d = 3 everywhere: the sums of a rectangle.
  const Image<float> map(70, 37, 3);
  const test::DevicePlane<float> disparity(map.view());
  sums_->run({disparity.view(), {}}, roll_from_sums(0, {}), nullptr);
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  const RawSums& s = sums_->solved().sums;
  EXPECT_EQ(s.n, 70 * 37);
  EXPECT_NEAR(s.u, 0, 1e-9);
  EXPECT_NEAR(s.vd, 0, 1e-9);
  EXPECT_NEAR(s.uu, 37 * 70.0 * (70 * 70 - 1) / 12, 1e-6);
  EXPECT_NEAR(s.vv, 70 * 37.0 * (37 * 37 - 1) / 12, 1e-6);
  EXPECT_EQ(s.dd, 9 * 70 * 37);
}

}  // namespace
}  // namespace roadstereo::cuda
