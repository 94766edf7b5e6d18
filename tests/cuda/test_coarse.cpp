// The coarse search on the device against CoarseSearch of the host: the same ranges, and a prior that differs by
// rounding.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#if defined(ROADSTEREO_CUDA_EMULATED)
#include "tests/cuda/emulated/run_kernel.hpp"
#endif
#include "roadstereo/perspective.hpp"
#include "roadstereo/synth.hpp"
#include "stereo/coarse/coarse_search.hpp"
#include "stereo/coarse/cuda/coarse_search.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaCoarse : public test::OnDevice {};

/// A pair, what is known of it, and how it is looked at.
struct Case {
  test::TexturedPair pair;
  int disparities;
  PerspectiveShift shift{};
  std::vector<int> first_column{};
  CoarseSearchOptions options{};
};

void expect_ranges(ImageView<const SearchRange> found, const Image<SearchRange>& expected) {
  ASSERT_EQ(found.pixels(), expected.pixels());
  const auto ranges = test::to_host(found.data(), expected.pixels());
  std::size_t differ = 0;
  for (std::size_t tile = 0; tile < expected.pixels(); ++tile) {
    const auto& range = expected.row(0)[tile];
    differ += ranges[tile].first != range.first || ranges[tile].end != range.end ? 1U : 0U;
  }
  // One pixel more or less decides on a bin with exactly the support needed.
  EXPECT_LE(differ, test::kernels_round_as_host ? 0U : 1U) << "of " << expected.pixels() << " tiles";
}

void expect_map(ImageView<const float> on_device, const Image<float>& expected) {
  ASSERT_EQ(on_device.width(), expected.width());
  ASSERT_EQ(on_device.height(), expected.height());
  if (expected.empty()) return;
  Image<float> found(expected.width(), expected.height());
  const auto numbers = test::to_host(on_device.data(), found.pixels());
  std::copy(numbers.begin(), numbers.end(), found.row(0));
  int off = 0;
  for (int v = 0; v < expected.height(); ++v) {
    for (int u = 0; u < expected.width(); ++u) {
      const float a = found(u, v), b = expected(u, v);
      off += std::isnan(b) ? !std::isnan(a) : !(std::abs(a - b) <= 1e-3F);
    }
  }
  EXPECT_LE(off, 0.005 * static_cast<double>(expected.pixels()));
}

void expect_as_on_host(cuda::CudaCoarseSearch& look, const Case& of) {
  CoarseSearch search(of.options, 1);
  const int* columns = of.first_column.empty() ? nullptr : of.first_column.data();
  ASSERT_TRUE(search.find({of.pair.reference, of.pair.target, columns, of.disparities}, of.shift));
  const test::DevicePlane<std::int16_t> reference(of.pair.reference), target(of.pair.target);
  const auto device_columns = test::to_device(of.first_column);
  ASSERT_TRUE(look.find(
      {reference.view(), target.view(), columns != nullptr ? device_columns.data() : nullptr, of.disparities, {}, {}},
      of.shift, nullptr));
  ASSERT_EQ(look.prior().factor, search.prior().factor);
  expect_map(look.prior().disparity, search.prior().disparity);
  expect_map(look.prior().low, search.prior().low);
  expect_map(look.prior().high, search.prior().high);
  ASSERT_EQ(look.ranges().empty(), search.ranges() == nullptr);
  if (search.ranges() == nullptr) return;
  expect_ranges(look.ranges().reference, search.ranges()->reference);
  expect_ranges(look.ranges().target, search.ranges()->target);
}

PerspectiveShift no_shift() {
  PerspectiveShift shift;
  shift.enabled = false;
  return shift;
}

/// A road that was shifted to δp but for what lies beyond the horizon, with a hole in it and no texture in some places.
Case road_with_a_hole(int width, int height, CoarseSearchOptions options) {
  const DisparityPlane road{-8, 0.5, 0.02};
  constexpr double delta_p = 12;
  Case of{test::textured_pair(width, height,
                              [&](double u, double v) {
                                const bool hole = u > 70 && u < 100 && v > 50 && v < 80;
                                return std::clamp(road.disparity(u, v), 0.0, delta_p) - (hole ? 5 : 0);
                              }),
          30,
          {road, delta_p, 30},
          {},
          options};
  for (int v = 60; v < 75; ++v) {
    std::fill(of.pair.reference.row(v) + 20, of.pair.reference.row(v) + 60, std::int16_t{2000});
    std::fill(of.pair.target.row(v) + 8, of.pair.target.row(v) + 48, std::int16_t{2000});
  }
  for (int v = 0; v < height; ++v) of.first_column.push_back(v / 6);
  return of;
}

TEST_F(CudaCoarse, RoadWithHoleMatchesHost) {
  cuda::CudaCoarseSearch look({});
  expect_as_on_host(look, road_with_a_hole(129, 85, {}));
}

TEST_F(CudaCoarse, RenderedStreetMatchesHost) {
  synth::Scene scene = synth::named_scene("street");
  scene.rig.focal_px *= 128.0 / scene.rig.width;
  scene.rig.width = 128;
  scene.rig.height = 64;
  scene.supersampling = 1;
  const synth::SyntheticPair pair = synth::render(scene, 1);
  Case of{{}, 24, {pair.plane, 12, 24}};
  GreyImage right;
  to_grey(pair.left.view(), 0, of.pair.reference);
  to_grey(pair.right.view(), 0, right);
  transform_target(right, of.shift, 1, of.pair.target, of.first_column);
  cuda::CudaCoarseSearch look({}, 10000);  // in bands of four rows
  expect_as_on_host(look, of);
}

TEST_F(CudaCoarse, OtherOptionsMatchHost) {
  CoarseSearchOptions options;
  options.factor = 4;
  options.block_radius = 2;
  options.ncc_noise_sigma = 0;
  options.step_penalty = 0.3;
  options.jump_penalty = 0.9;
  cuda::CudaCoarseSearch look(options);
  expect_as_on_host(look, road_with_a_hole(230, 100, options));
}

TEST_F(CudaCoarse, WeakTextureMatchesHostDespiteWrongRoad) {
  cuda::CudaCoarseSearch look({});
  const auto ten = [](double, double) { return 10; };
  expect_as_on_host(look, {test::textured_pair(97, 64, ten, 1, 0.05), 30, {{18, 0, 0}, 18, 30}});
}

TEST_F(CudaCoarse, TargetTilesIncludeShiftedReferencePixels) {
  CoarseSearchOptions options;
  options.factor = 8;
  cuda::CudaCoarseSearch look(options);
  const auto wall = [](double u, double) { return u < 204 ? 8 : 40; };
  expect_as_on_host(look, {test::textured_pair(400, 100, wall), 48, no_shift(), {}, options});
}

TEST_F(CudaCoarse, ManyDisparitiesWithoutRoadMatchHost) {
  cuda::CudaCoarseSearch look({});
  const auto wavy = [](double u, double v) { return 12 + 0.02 * v + 2 * std::sin(0.04 * u); };
  expect_as_on_host(look, {test::textured_pair(101, 65, wavy), 80, no_shift()});
}

TEST_F(CudaCoarse, LargestBlocksWithMostDisparitiesMatchHost) {
  CoarseSearchOptions options;
  options.factor = 2;
  options.block_radius = 10;
  cuda::CudaCoarseSearch look(options);
  const auto ramp = [](double u, double) { return 0.02 * u; };
  expect_as_on_host(look, {test::textured_pair(258, 64, ramp), 1024, no_shift(), {}, options});
}

TEST_F(CudaCoarse, FewDisparitiesGiveNoRanges) {
  cuda::CudaCoarseSearch look({});
  const Case of{test::textured_pair(65, 64, [](double, double) { return 4; }), 8, no_shift()};
  expect_as_on_host(look, of);
  EXPECT_TRUE(look.ranges().empty());
}

#if defined(ROADSTEREO_CUDA_EMULATED)
TEST_F(CudaCoarse, SecondFrameAllocatesNothing) {
  const auto pair = test::textured_pair(65, 64, [](double, double) { return 4; });
  const test::DevicePlane<std::int16_t> reference(pair.reference), target(pair.target);
  cuda::CudaCoarseSearch look({});
  std::size_t allocations[2] = {};
  for (std::size_t& count : allocations) {
    ASSERT_TRUE(look.find({reference.view(), target.view(), nullptr, 16}, {}, nullptr));
    count = cuda::emulated::allocations();
  }
  EXPECT_EQ(allocations[0], allocations[1]);
}
#endif

TEST_F(CudaCoarse, SkipsSmallImages) {
  const GreyImage small(100, 60, 1600);
  const test::DevicePlane<std::int16_t> image(small);
  cuda::CudaCoarseSearch look({});
  EXPECT_FALSE(look.find({image.view(), image.view(), nullptr, 32}, {}, nullptr));
  EXPECT_TRUE(look.ranges().empty());
}

}  // namespace
}  // namespace roadstereo
