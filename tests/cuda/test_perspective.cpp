// The perspective transformation on the device against the host's.

#include <cmath>
#include <limits>

#include "road/cuda/perspective.hpp"
#include "roadstereo/perspective.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaPerspective : public test::OnDevice {};

/// Shifts of every kind: sub-pixel, whole pixels, rows with an offset, a turn, none, a horizon within the image, one
/// that moves everything out of it.
std::vector<PerspectiveShift> shifts() {
  const DisparityPlane rolled{-2.3, 0.31, -0.043}, level{10.1, 0.2, 0}, far_away{500, 0.1, 0.01};
  return {{rolled, 3.5, 32},
          {rolled, 3.5, 32, true},
          {level, 6, 24, false, true, {0.3}},
          {rolled, 2, 24, false, true, {-1.7}},
          {level, 6, 24, true, true, {1}},
          {rolled, 2, 24, false, true, {0.2, 0.012, -0.003, 60, 25}},
          {level, 6, 24, false, false, {0, -0.02, 0, 300, 20}},
          {level, 6, 24, false, false},
          {far_away, 6, 24}};
}

struct Size {
  int width, height;
};

TEST_F(CudaPerspective, TransformedTargetMatchesHost) {
  for (const Size size : {Size{33, 35}, Size{129, 47}, Size{641, 59}}) {
    const auto pair = test::textured_pair(size.width, size.height, [](double, double) { return 0; });
    const test::DevicePlane<std::int16_t> target(pair.target), transformed(size.width, size.height);
    int off = 0;
    for (const PerspectiveShift& shift : shifts()) {
      GreyImage expected;
      std::vector<int> first_column;
      transform_target(pair.target, shift, 1, expected, first_column);
      cuda::DeviceArray<int> columns(first_column.size());
      cuda::transform_target(target.view(), shift, grey_max, transformed.plane(), columns.data(), nullptr);
      const GreyImage found = transformed.on_host();
      EXPECT_EQ(test::to_host(columns.data(), first_column.size()), first_column);
      for (int v = 0; v < size.height; ++v) {
        for (int u = 0; u < size.width; ++u) {
          ASSERT_LE(std::abs(found(u, v) - expected(u, v)), 1) << u << ", " << v;
          off += found(u, v) != expected(u, v);
        }
      }
    }
    EXPECT_LE(off, 0.001 * size.width * size.height * static_cast<double>(shifts().size()));
  }
}

TEST_F(CudaPerspective, AddedShiftMatchesHost) {
  constexpr int width = 129, height = 47;
  Image<float> residual(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double value = 30 * test::lattice(u, v, 1);
      residual(u, v) = value < 2 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value);
    }
  }
  const test::DevicePlane<float> in(residual), out(width, height);
  for (const PerspectiveShift& shift : shifts()) {
    Image<float> expected;
    restore_disparity(residual, shift, 1, 1, expected);
    cuda::restore_disparity(in.view(), shift, 1, out.plane(), nullptr);
    const Image<float> found = out.on_host();
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        ASSERT_EQ(std::isnan(found(u, v)), std::isnan(expected(u, v)));
        if (!std::isnan(expected(u, v))) {
          ASSERT_NEAR(found(u, v), expected(u, v), 1e-5 * std::max(1.0F, expected(u, v) / 64));
        }
      }
    }
  }
}

}  // namespace
}  // namespace roadstereo
