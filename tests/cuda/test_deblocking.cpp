// Steps between the blocks of JPEG on the device: the same bits as on the host.

#include <array>
#include <utility>

#include "core/cuda/deblocking.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaDeblocking : public test::OnDevice {};

GreyImage block_image(int width, int height, double step, std::uint64_t seed) {
  GreyImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double level = 1000 + 80 * test::lattice(u, v, seed) + step * test::lattice(u / 8, v / 8, seed + 1);
      image(u, v) = static_cast<std::int16_t>(level);
    }
  }
  return image;
}

TEST_F(CudaDeblocking, MatchesHost) {
  cuda::PairDeblocking deblocking;
  for (const auto& [width, height] : {std::pair{129, 47}, {32, 32}, {200, 131}, {33, 90}}) {
    for (const bool smooth : {true, false}) {
      std::array<GreyImage, 2> images{block_image(width, height, 90, 1),
                                      block_image(width, height, 0, 3)};  // one has no blocks
      const test::DevicePlane<std::int16_t> left(images[0]), right(images[1]);
      deblocking.run(left.plane(), right.plane(), smooth, nullptr);
      const std::array<GreyImage, 2> found{left.on_host(), right.on_host()};
      for (std::size_t k = 0; k < images.size(); ++k) {
        const BlockSteps steps = measure_block_steps(images[k]);
        const int strength = deblocking_strength(steps, BlockStepSamples(width, height).count());
        EXPECT_EQ(strength > 0, k == 0);
        if (smooth && strength > 0) smooth_block_steps(images[k], strength);
        EXPECT_EQ(found[k], images[k]) << width << "×" << height << " " << k;
        EXPECT_EQ(deblocking.excess()[k], steps.excess());
      }
    }
  }
}

}  // namespace
}  // namespace roadstereo
