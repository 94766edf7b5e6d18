// Lucas–Kanade step on the device against lucas_kanade of the host.

#include <cmath>
#include <limits>
#include <vector>

#include "road/lucas_kanade/alignment_maps.hpp"
#include "road/lucas_kanade/cuda/lucas_kanade.hpp"
#include "road/lucas_kanade/settings.hpp"
#include "roadstereo/perspective.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaLucasKanade : public test::OnDevice {};

void expect_step_as_on_host(int width, int height, const PerspectiveShift& shift, const LucasKanadeOptions& options) {
  const auto truth = [&](double u, double v) { return shift.at(u, v) + 4.3 + std::sin(0.05 * u + 0.1 * v); };
  const test::TexturedPair pair = test::textured_pair(width, height, truth);
  GreyImage target;
  std::vector<int> first_column;
  transform_target(pair.target, shift, 1, target, first_column);
  Image<float> disparity(width, height), expected;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool hole = test::lattice(u, v, 8) < 0.05 || test::smooth_noise(u, v, 14, 5) < 0.2;
      const double noise = test::smooth_noise(u, v, 9, 4) - 0.5;
      disparity(u, v) = hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(truth(u, v) + 0.3 * noise);
    }
  }
  Image<float> expected_correlation;
  lucas_kanade({pair.reference, target, first_column.data(), shift}, disparity, options, 1, expected,
               expected_correlation);
  const test::DevicePlane<std::int16_t> device_reference(pair.reference), device_target(target);
  const test::DevicePlane<float> device_disparity(disparity), aligned(width, height);
  const cuda::DeviceArray<int> device_columns = test::to_device(first_column);
  cuda::LucasKanade step;
  const ImageView<const float> cells =
      step.run({device_reference.view(), device_target.view(), device_columns.data(), shift}, device_disparity.view(),
               options.radius, alignment_settings(options), aligned.plane(), nullptr);
  const Image<float> found = aligned.on_host();
  const std::vector<float> correlation = test::to_host(cells.data(), cells.pixels());
  ASSERT_EQ(correlation.size(), expected_correlation.pixels());
  for (std::size_t k = 0; k < correlation.size(); ++k) {
    ASSERT_NEAR(correlation[k], expected_correlation.row(0)[k], 1e-3) << "cell " << k;
  }
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      ASSERT_EQ(std::isnan(found(u, v)), std::isnan(expected(u, v))) << u << ", " << v;
      if (std::isnan(expected(u, v))) continue;
      ASSERT_NEAR(found(u, v), expected(u, v), 5e-4) << u << ", " << v;
    }
  }
}

TEST_F(CudaLucasKanade, MatchesHost) {
  const PerspectiveShift tilted{{6, 0.2, 0.05}, 4, 16};
  PerspectiveShift none;
  none.enabled = false;
  expect_step_as_on_host(131, 45, tilted, {});
  expect_step_as_on_host(64, 32, none, {});
  expect_step_as_on_host(20, 9, none, {});
}

TEST_F(CudaLucasKanade, EveryWindowSizeMatchesHost) {
  const PerspectiveShift shift{{6, 0.2, 0.05}, 4, 16};
  for (const int radius : {1, 4, 8}) {
    LucasKanadeOptions options;
    options.radius = radius;
    expect_step_as_on_host(97, 40, shift, options);
    expect_step_as_on_host(300, 40, shift, options);  // cells of several blocks across
  }
}

}  // namespace
}  // namespace roadstereo
