// Smoothing of an image on the device: the same bits as on the host.

#include <utility>

#include "core/cuda/gaussian_smoothing.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaGaussianSmoothing : public test::OnDevice {};

TEST_F(CudaGaussianSmoothing, MatchesHost) {
  for (const auto& [width, height] : {std::pair{129, 47}, {32, 32}, {300, 90}}) {
    for (const double variance_px2 : {0.2, 2.5, 16.0}) {
      GreyImage image = test::textured_pair(width, height, [](double, double) { return 0; }).reference;
      GreyImage between(width, height);
      const test::DevicePlane<std::int16_t> on_device(image), scratch(image);
      const SmoothingKernel kernel = smoothing_kernel(variance_px2);
      cuda::smooth_image(kernel, on_device.plane(), scratch.plane(), nullptr);
      smooth_image(kernel, 1, image, between);
      EXPECT_EQ(on_device.on_host(), image) << width << "×" << height << ", " << variance_px2;
    }
  }
}

}  // namespace
}  // namespace roadstereo
