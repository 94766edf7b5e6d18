// Refinement on the device against refine_disparities of the host.

#include <cmath>
#include <limits>

#include "road/refinement/cuda/interpolation.hpp"
#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/cuda/refinement_settings.hpp"
#include "roadstereo/perspective.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double support = 100;

class CudaRefinement : public test::OnDevice {};

/// Residual disparities around δp with steps, holes of all sizes and outliers, and variances from tiny to infinite.
struct Maps {
  Image<float> residual, variance;

  Maps(int width, int height) : residual(width, height), variance(width, height) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double chance = test::lattice(u, v, 8), noise = test::lattice(u, v, 9) - 0.5;
        const double step = test::smooth_noise(u, v, 21, 3) > 0.6 ? 3 : 0;
        const bool hole = chance < 0.05 || test::smooth_noise(u, v, 14, 5) < 0.2;
        residual(u, v) = hole ? nan : static_cast<float>(6 + step + 0.6 * noise + (chance > 0.98 ? 5 : 0));
        variance(u, v) = chance > 0.95 ? std::numeric_limits<float>::infinity()
                                       : static_cast<float>(0.2 * std::pow(test::lattice(u, v, 10), 4));
      }
    }
  }
};

void expect_equal(const Image<float>& found, const Image<float>& expected) {
  int patterns = 0;
  for (int v = 0; v < found.height(); ++v) {
    for (int u = 0; u < found.width(); ++u) {
      if (found(u, v) == expected(u, v)) continue;  // infinite standard errors, too
      if (std::isnan(found(u, v)) != std::isnan(expected(u, v))) {
        ++patterns;
      } else if (!std::isnan(expected(u, v))) {
        ASSERT_NEAR(found(u, v), expected(u, v), 1e-4) << u << ", " << v;
      }
    }
  }
  EXPECT_LE(patterns, 0.0001 * static_cast<double>(found.pixels()));
}

void expect_as_on_host(int width, int height, const PerspectiveShift& shift, const RefinementOptions& options) {
  const Maps maps(width, height);
  Image<float> full, refined, sigma;
  restore_disparity(maps.residual, shift, 1, 1, full);
  refine_disparities(full, maps.variance, 1, shift.road, support, options, 1, refined, sigma);
  const test::DevicePlane<float> disparity(full), variance(maps.variance);
  const test::DevicePlane<float> device_refined(width, height), device_sigma(width, height);
  const test::DevicePlane<float> between_disparity(width, height), between_variance(width, height);
  const test::DevicePlane<float> across(width, height), down(width, height);
  const cuda::SlopeMaps slopes{across.plane(), down.plane()};
  if (pass_count(options) == 1) {
    cuda::refine_disparities(disparity.view(), variance.view(), shift.road,
                             cuda::refinement_settings(options, 0, support), slopes, device_refined.plane(),
                             device_sigma.plane(), nullptr);
  } else {
    cuda::refine_disparities(disparity.view(), variance.view(), shift.road,
                             cuda::refinement_settings(options, 0, support), slopes, between_disparity.plane(),
                             between_variance.plane(), nullptr);
    cuda::refine_disparities(between_disparity.view(), between_variance.view(), shift.road,
                             cuda::refinement_settings(options, 1, support), slopes, device_refined.plane(),
                             device_sigma.plane(), nullptr);
  }
  expect_equal(device_refined.on_host(), refined);
  expect_equal(device_sigma.on_host(), sigma);
}

TEST_F(CudaRefinement, MatchesHost) {
  const DisparityPlane road{12, 0.31, -0.07};
  for (const PerspectiveShift& shift : {PerspectiveShift{road, 6, 32}, PerspectiveShift{road, 6, 32, true},
                                        PerspectiveShift{{}, 0, 32, false, false}}) {
    expect_as_on_host(129, 47, shift, {});
  }
}

TEST_F(CudaRefinement, EveryWindowSizeMatchesHost) {
  const PerspectiveShift shift{{12, 0.31, -0.07}, 6, 32};
  for (const RefinementOptions& options :
       {RefinementOptions{.radius = 0}, RefinementOptions{.passes = 1, .radius = 1, .step = 1},
        RefinementOptions{.radius = 10, .step = 4, .truncation_sigmas = 3},
        RefinementOptions{.radius = 32, .step = 16}}) {
    SCOPED_TRACE(options.radius);
    expect_as_on_host(33, 35, shift, options);
  }
}

TEST_F(CudaRefinement, InterpolationMatchesHost) {
  const DisparityPlane road{12, 0.31, -0.07};
  for (const auto& [width, height] : {std::pair{129, 47}, {128, 46}, {1, 1}, {3, 2}}) {
    const Maps maps((width + 1) / 2, (height + 1) / 2);
    Image<float> full, sigma;
    interpolate_disparities(maps.residual, maps.variance, road, width, height, 1, full, sigma);
    const test::DevicePlane<float> residual(maps.residual), variance(maps.variance);
    const test::DevicePlane<float> device_full(width, height), device_sigma(width, height);
    cuda::interpolate_disparities(residual.view(), variance.view(), road, device_full.plane(), device_sigma.plane(),
                                  nullptr);
    expect_equal(device_full.on_host(), full);
    expect_equal(device_sigma.on_host(), sigma);
  }
}

}  // namespace
}  // namespace roadstereo
