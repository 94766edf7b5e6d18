// The whole pipeline in device memory against the same pipeline on the host, frame after frame.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"
#if defined(ROADSTEREO_CUDA_EMULATED)
#include "tests/cuda/emulated/run_kernel.hpp"
#endif

namespace roadstereo {
namespace {

constexpr int width = 192, height = 112;

synth::SyntheticPair frame_of(const std::string& name, int frame = 0, int downsample = 1, double noise_grey = 0) {
  synth::Scene scene = synth::named_scene(name);
  scene.supersampling = 1;
  scene.rig.focal_px *= static_cast<double>(width) / downsample / scene.rig.width;
  scene.rig.width = width / downsample;
  scene.rig.height = height / downsample;
  scene.degradation.noise_grey = noise_grey;
  return synth::render(synth::flight_frame(scene, {}, frame), 2);
}

PipelineOptions options_of(const std::string& preset_name, const std::string& engine) {
  PipelineOptions options = preset(preset_name);
  options.engine = engine;
  options.threads = 2;
  return options;
}

/// How far two maps differ.
struct Difference {
  double same_share = 0;  ///< of the pixels: within 0.01 px, or both invalid
  double median = 0;      ///< over what both have

  /// `offset`: by how much b is higher.
  Difference(const Image<float>& a, const Image<float>& b, double offset = 0) {
    std::vector<double> differences;
    std::size_t same = 0;
    for (int v = 0; v < a.height(); ++v) {
      for (int u = 0; u < a.width(); ++u) {
        const float x = a(u, v), y = b(u, v) - static_cast<float>(offset);
        const bool neither = std::isnan(x) && std::isnan(y);
        same += neither || std::abs(x - y) <= 0.01F ? 1U : 0U;
        if (!std::isnan(x) && !std::isnan(y)) differences.push_back(std::abs(double{x} - double{y}));
      }
    }
    std::sort(differences.begin(), differences.end());
    same_share = static_cast<double>(same) / static_cast<double>(a.pixels());
    median = differences.empty() ? 0 : differences[differences.size() / 2];
  }
};

class CudaPipeline : public test::OnDevice {};
using SlowCudaPipeline = CudaPipeline;
using CudaPipelineTwoGpus = CudaPipeline;

class CudaPreset : public test::OnDevice, public testing::WithParamInterface<std::string> {};

TEST_F(CudaPipeline, SubtractsRigBiasAsHostDoes) {
  const synth::SyntheticPair pair = frame_of("uav");
  PipelineOptions on_host = options_of("default", "cpu"), on_device = options_of("default", "cuda");
  RigBias bias;
  bias.width = width;
  bias.height = height;
  bias.order = 4;
  bias.value_px = {0.1, 0, 0, 0.5, 0.2, -0.4, 0.3, 0.1, 0.2, -0.6, 0.4, 0.2, 0.1, 0.3, 0.5};
  bias.region_px = {20, 30, 170, 100};
  on_host.rig_bias = on_device.rig_bias = bias;
  Pipeline host(on_host, pair.calibration), device(on_device, pair.calibration);
  const FrameResult& expected = host.process(pair.left.view(), pair.right.view());
  const FrameResult& found = device.process(pair.left.view(), pair.right.view());
  EXPECT_GE(Difference(expected.disparity, found.disparity).same_share, 0.999);
  EXPECT_NEAR(expected.geometry.alpha0, found.geometry.alpha0, 0.01);
  Pipeline plain(options_of("default", "cuda"), pair.calibration);
  EXPECT_LT(Difference(expected.disparity, plain.process(pair.left.view(), pair.right.view()).disparity).same_share,
            0.1);
}

// A search for a road amplifies rounding: it must see the same grey levels.
TEST_F(CudaPipeline, FindsRoadBetweenMisalignedRowsThatHostFinds) {
  synth::Scene scene = synth::named_scene("street");
  scene.supersampling = 1;
  scene.degradation.row_offset_px = 0.37;
  scene.degradation.row_rotation_deg = 0.05;
  const synth::SyntheticPair pair = synth::render(scene, 2);
  Pipeline host(options_of("fast", "cpu"), pair.calibration), device(options_of("fast", "cuda"), pair.calibration);
  const FrameResult& expected = host.process(pair.left.view(), pair.right.view());
  const FrameResult& found = device.process(pair.left.view(), pair.right.view());
  EXPECT_FALSE(expected.shift.misalignment.is_zero());
  for (const double v : {0.0, 1.0}) {
    for (const double u : {0.0, 1.0}) EXPECT_EQ(found.road.model.disparity(u, v), expected.road.model.disparity(u, v));
  }
  EXPECT_EQ(found.road.correlation, expected.road.correlation);
}

/// Thrice the mean of three by three pixels: a blur of 2 pixels².
void defocus(Frame& frame) {
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<std::uint8_t> before = frame.bytes;
    for (int v = 1; v + 1 < frame.height; ++v) {
      for (int u = 1; u + 1 < frame.width; ++u) {
        int sum = 4;
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) sum += before[static_cast<std::size_t>((v + dv) * frame.width + u + du)];
        }
        frame.bytes[static_cast<std::size_t>(v * frame.width + u)] = static_cast<std::uint8_t>(sum / 9);
      }
    }
  }
}

TEST_F(CudaPipeline, EqualisesBlurAsHostDoes) {
  const StereoCalibration calibration = frame_of("uav").calibration;
  Pipeline host(options_of("default", "cpu"), calibration), device(options_of("default", "cuda"), calibration);
  for (int frame = 0; frame < 2; ++frame) {
    synth::SyntheticPair pair = frame_of("uav", frame);
    defocus(pair.right);
    const FrameResult& expected = host.process(pair.left.view(), pair.right.view());
    const FrameResult& found = device.process(pair.left.view(), pair.right.view());
    EXPECT_NEAR(expected.smoothed_px2, 2, 0.5);
    EXPECT_EQ(found.smoothed_px2, expected.smoothed_px2);
    EXPECT_EQ(found.blur.known(), frame == 0);
    EXPECT_EQ(found.grey, expected.grey);
    EXPECT_EQ(found.right, expected.right);
    EXPECT_GE(Difference(expected.disparity, found.disparity).same_share, 0.99);
  }
}

TEST_P(CudaPreset, MatchesHostFrameByFrame) {
  const StereoCalibration calibration = frame_of("uav").calibration;
  Pipeline host(options_of(GetParam(), "cpu"), calibration), device(options_of(GetParam(), "cuda"), calibration);
  for (int frame = 0; frame < 3; ++frame) {
    const synth::SyntheticPair pair = frame_of("uav", frame);
    const FrameResult& expected = host.process(pair.left.view(), pair.right.view());
    const FrameResult& found = device.process(pair.left.view(), pair.right.view());
    SCOPED_TRACE("frame " + std::to_string(frame));
    EXPECT_EQ(found.grey, expected.grey);
    EXPECT_EQ(found.right, expected.right);
    EXPECT_EQ(found.road.has_road(), expected.road.has_road());
    EXPECT_EQ(found.road.status, expected.road.status);
    EXPECT_EQ(found.road.status == RoadStatus::tracked, frame > 0);
    EXPECT_NEAR(found.shift.disparities, expected.shift.disparities, test::kernels_round_as_host ? 0 : 1);
    for (const double v : {0.0, height - 1.0}) {
      EXPECT_NEAR(found.road.model.disparity(0, v), expected.road.model.disparity(0, v), 2e-3);
      EXPECT_NEAR(found.geometry.plane.disparity(0, v), expected.geometry.plane.disparity(0, v), 5e-3);
    }
    EXPECT_TRUE(found.roll_found);
    EXPECT_NEAR(found.geometry.roll_rad, expected.geometry.roll_rad, 2e-4);
    EXPECT_NEAR(found.geometry.residual_px, expected.geometry.residual_px, 0.02 * expected.geometry.residual_px);
    // The floor of the lowest height, which is that of one pixel.
    EXPECT_NEAR(found.delta_t, expected.delta_t, test::kernels_round_as_host ? 0 : 1);
    const double offset = found.delta_t - expected.delta_t;
    EXPECT_NEAR(found.spread.sigma_road_px, expected.spread.sigma_road_px, 0.02 * expected.spread.sigma_road_px);
    EXPECT_NEAR(found.valid_share, expected.valid_share, 2e-3);
    const Difference disparity(expected.disparity, found.disparity), sigma(expected.sigma, found.sigma),
        transformed(expected.transformed, found.transformed, offset);
    RecordProperty("same_disparities_" + std::to_string(frame), std::to_string(disparity.same_share));
    RecordProperty("same_sigmas_" + std::to_string(frame), std::to_string(sigma.same_share));
    EXPECT_GE(disparity.same_share, 0.99);
    EXPECT_GE(sigma.same_share, 0.99);
    EXPECT_LE(disparity.median, 1e-3);
    EXPECT_LE(transformed.median, 5e-3);
    EXPECT_EQ(found.warnings, expected.warnings);
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, CudaPreset, testing::Values("default", "fast"),
                         [](const auto& test) { return test.param; });
INSTANTIATE_TEST_SUITE_P(Slow, CudaPreset, testing::Values("paper"), [](const auto& test) { return test.param; });

TEST_F(CudaPipeline, TakesAndReturnsDeviceMemory) {
  const synth::SyntheticPair pair = frame_of("uav");
  Pipeline usual(options_of("fast", "cuda"), pair.calibration), there(options_of("fast", "cuda"), pair.calibration);
  const FrameResult& expected = usual.process(pair.left.view(), pair.right.view());

  cudaStream_t stream = nullptr;
  ROADSTEREO_CUDA(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  there.set_device_options({.stream = stream, .download = false});
  const cuda::DeviceArray<std::uint8_t> left = test::to_device(pair.left.bytes),
                                        right = test::to_device(pair.right.bytes);
  FrameView left_view = pair.left.view(), right_view = pair.right.view();
  left_view.data = left.data();
  right_view.data = right.data();
  const FrameResult& found = there.process(left_view, right_view);
  EXPECT_TRUE(found.disparity.empty() && found.sigma.empty() && found.transformed.empty() && found.grey.empty());
  EXPECT_EQ(found.delta_t, expected.delta_t);
  EXPECT_EQ(found.geometry.roll_rad, expected.geometry.roll_rad);
  EXPECT_EQ(found.valid_share, expected.valid_share);

  const DeviceMaps maps = there.device_maps();
  EXPECT_EQ(maps.stream, stream);
  ASSERT_EQ(maps.width, width);
  ASSERT_EQ(maps.height, height);
  const auto same_bits = [](const Image<float>& image, const float* on_device) {
    const std::vector<float> copy = test::to_host(on_device, image.pixels());
    return std::memcmp(copy.data(), image.row(0), image.pixels() * sizeof(float)) == 0;
  };
  EXPECT_TRUE(same_bits(expected.disparity, maps.disparity));
  EXPECT_TRUE(same_bits(expected.sigma, maps.sigma));
  EXPECT_TRUE(same_bits(expected.transformed, maps.transformed));
  EXPECT_EQ(test::to_host(maps.grey, 1).front(), expected.grey(0, 0));
  try {
    there.find_damage();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("left on the device"), std::string::npos) << error.what();
  }
  left_view.data = pair.left.bytes.data();
  EXPECT_THROW(there.process(left_view, right_view), Error);  // one here, one there
  there.set_device_options({});                               // before the stream goes
  ROADSTEREO_CUDA(cudaStreamDestroy(stream));
}

/// The maps lie in pinned memory, which the device writes and the caller gets: the result outlives the pipeline, and
/// two results in turn need no memory after the first frames.
TEST_F(CudaPipeline, HandsOutPinnedMaps) {
  const synth::SyntheticPair pair = frame_of("uav", 0, 2);
  FrameResult results[2];
  {
    Pipeline pipeline(options_of("fast", "cuda"), pair.calibration);
    for (int frame = 0; frame < 4; ++frame) pipeline.process(pair.left.view(), pair.right.view(), results[frame % 2]);
    ASSERT_NE(results[0].disparity.memory(), nullptr);
    ASSERT_NE(results[0].right.memory(), nullptr);
#if defined(ROADSTEREO_CUDA_EMULATED)
    const std::size_t before = cuda::emulated::allocations();
    for (int frame = 0; frame < 2; ++frame) pipeline.process(pair.left.view(), pair.right.view(), results[frame]);
    EXPECT_EQ(cuda::emulated::allocations(), before);
#endif
  }
  EXPECT_EQ(results[0].grey, results[1].grey);
  EXPECT_EQ(results[0].right, results[1].right);
  // The road that the frame before leaves differs in its last bits.
  EXPECT_GE(Difference(results[0].disparity, results[1].disparity).same_share, test::kernels_round_as_host ? 1 : 0.999);
  const Image<float> copy = results[0].disparity;
  EXPECT_EQ(copy.memory(), nullptr);
  EXPECT_TRUE(std::isfinite(copy(copy.width() / 2, copy.height() / 2)));
}

/// Maps that the caller holds are those of their frame, whatever comes after it; released memory serves again.
TEST_F(CudaPipeline, HeldDeviceMapsStay) {
  const synth::SyntheticPair pair = frame_of("uav", 0, 2), next = frame_of("uav", 3, 2), larger = frame_of("uav");
  const auto disparities = [](const DeviceMaps& maps) {
    return test::to_host(maps.disparity, static_cast<std::size_t>(maps.width) * static_cast<std::size_t>(maps.height));
  };
  const auto same_bits = [](const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
  };
  DeviceMaps held;
  std::vector<float> expected;
  {
    Pipeline pipeline(options_of("fast", "cuda"));
    EXPECT_THROW(pipeline.device_maps(), Error);
    pipeline.process(pair.left.view(), pair.right.view());
    held = pipeline.device_maps();
    EXPECT_EQ(held.device, cuda::is_emulated ? -1 : 0);
    EXPECT_EQ(pipeline.device_maps().owner, held.owner);
    expected = disparities(held);
    pipeline.process(next.left.view(), next.right.view());
    const float* second = pipeline.device_maps().disparity;
    EXPECT_NE(second, held.disparity);
    EXPECT_FALSE(same_bits(disparities(pipeline.device_maps()), expected));
    for (int frame = 0; frame < 2; ++frame) pipeline.process(next.left.view(), next.right.view());
    EXPECT_EQ(pipeline.device_maps().disparity, second);
    pipeline.process(larger.left.view(), larger.right.view());  // other memory for what is not held
    EXPECT_TRUE(same_bits(disparities(held), expected));
  }
  EXPECT_TRUE(same_bits(disparities(held), expected));  // without the pipeline

  Pipeline pipeline(options_of("fast", "cuda"));
  std::vector<const float*> places;
  for (int frame = 0; frame < 4; ++frame) {
    pipeline.process(pair.left.view(), pair.right.view());
    held = pipeline.device_maps();  // releases those of the frame before, once they have a successor
    places.push_back(held.disparity);
  }
  EXPECT_NE(places[1], places[0]);
  EXPECT_EQ(places[2], places[0]);
  EXPECT_EQ(places[3], places[1]);
}

/// A following frame waits twice, for the road and for the end, and copies both frames and four maps; of a solver that
/// takes all disparities, too.
TEST_F(CudaPipeline, FollowingFrameWaitsTwice) {
  const synth::SyntheticPair pair = frame_of("uav");
  for (const RollSolver solver : {RollSolver::robust, RollSolver::gradient_descent}) {
    PipelineOptions options = options_of("fast", "cuda");
    options.roll.solver = solver;
    Pipeline pipeline(options, pair.calibration);
    EXPECT_THROW(pipeline.device_profile(), Error);
    pipeline.set_device_options({.timing = DeviceTiming::kernels});
    pipeline.process(pair.left.view(), pair.right.view());
    const StageTimes ms = pipeline.process(pair.left.view(), pair.right.view()).ms;
    const DeviceProfile profile = pipeline.device_profile();
    EXPECT_EQ(profile.waits, 2);
    EXPECT_EQ(profile.bytes_up, pair.left.bytes.size() + pair.right.bytes.size());
    EXPECT_EQ(profile.bytes_down, pair.left.bytes.size() * (3 * sizeof(float) + 2 * sizeof(std::int16_t)));
    int launches = 0;
    double kernels_ms = 0;
    for (const KernelProfile& kernel : profile.kernels) {
      launches += kernel.launches;
      kernels_ms += kernel.ms;
      EXPECT_GT(kernel.occupancy, 0) << kernel.name;
      EXPECT_LE(kernel.occupancy, 1) << kernel.name;
    }
    EXPECT_EQ(profile.launches, launches);
    RecordProperty("launches", launches);
    EXPECT_LE(launches, solver == RollSolver::robust ? 26 : 27);
    EXPECT_GT(kernels_ms, 0);
    EXPECT_LE(kernels_ms, ms.prepare + ms.road_model + ms.perspective + ms.coarse + ms.match + ms.refinement + ms.roll +
                              ms.transform);
  }
}

TEST_F(CudaPipeline, HasNoProfileOfFrameBefore) {
  const synth::SyntheticPair pair = frame_of("uav", 0, 2);
  Pipeline pipeline(options_of("fast", "cuda"));
  pipeline.process(pair.left.view(), pair.right.view());
  pipeline.set_device_options({.timing = DeviceTiming::kernels});
  EXPECT_THROW(pipeline.device_profile(), Error);
  EXPECT_NO_THROW(pipeline.device_maps());
  pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_GT(pipeline.device_profile().launches, 0);
}

TEST_F(CudaPipeline, TakesMaskWithoutSetPixels) {
  Pipeline pipeline(options_of("fast", "cuda"));
  EXPECT_NO_THROW(pipeline.set_mask(Image<std::uint8_t>(width, height, 0)));
  EXPECT_THROW(pipeline.set_mask(Image<std::uint8_t>(width, height, 255)), Error);
}

TEST_F(CudaPipeline, LeavesDeviceForMaskUnlessShared) {
  const Image<std::uint8_t> nothing(width, height, 0), everything(width, height, 255);
  Pipeline automatic(options_of("fast", "auto"));
  if (automatic.engine_name() != "cuda") GTEST_SKIP() << "auto is cuda on a GPU only";
  automatic.set_mask(nothing);
  EXPECT_EQ(automatic.engine_name(), "cuda");
  automatic.set_device_options({.download = false});
  EXPECT_THROW(automatic.set_mask(everything), Error);
  EXPECT_EQ(automatic.engine_name(), "cuda");
  automatic.set_device_options({});
  automatic.set_mask(everything);
  EXPECT_EQ(automatic.engine_name(), "cpu");
}

/// In noise the weight of the prior follows that of each frame: no reason to wait for what is being matched.
TEST_F(CudaPipeline, FollowingFrameInNoiseWaitsTwice) {
  synth::SyntheticPair pair = frame_of("uav", 0, 1, 8);
  Pipeline pipeline(options_of("default", "cuda"), pair.calibration);
  pipeline.set_device_options({.timing = DeviceTiming::kernels});
  pipeline.process(pair.left.view(), pair.right.view());
  pair = frame_of("uav", 1, 1, 8);
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_EQ(result.road.status, RoadStatus::tracked);
  EXPECT_LT(result.road.correlation, 0.8);
  EXPECT_EQ(pipeline.device_profile().waits, 2);
  EXPECT_LE(pipeline.device_profile().launches, 40);
}

TEST_F(CudaPipeline, TwoInTwoThreadsAreIndependent) {
  const synth::SyntheticPair uav = frame_of("uav", 0, 2), street = frame_of("street", 0, 2);
  const auto run = [](const synth::SyntheticPair& pair, int frames) {
    Pipeline pipeline(options_of("fast", "cuda"), pair.calibration);
    for (int frame = 1; frame < frames; ++frame) pipeline.process(pair.left.view(), pair.right.view());
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    return std::pair(result.geometry.roll_rad, result.delta_t);
  };
  const auto alone_uav = run(uav, 2), alone_street = run(street, 2);
  decltype(run(uav, 2)) beside_uav, beside_street;
  std::thread first([&] { beside_uav = run(uav, 2); });
  std::thread second([&] { beside_street = run(street, 2); });
  first.join();
  second.join();
  EXPECT_EQ(beside_uav, alone_uav);
  EXPECT_EQ(beside_street, alone_street);
}

class CudaMatching : public test::OnDevice {};
using CudaMatchingTwoGpus = CudaMatching;

TEST_F(CudaMatchingTwoGpus, UsesItsOwnDevice) {
  int devices = 0;
  ROADSTEREO_CUDA(cudaGetDeviceCount(&devices));
  if (devices < 2) GTEST_SKIP() << "there is one GPU";
  const auto pair = test::textured_pair(40, 34, [](double, double) { return 3; });
  const auto engine = make_engine("cuda", 1);
  MatchMaps maps;
  if (cudaSetDevice(1) != cudaSuccess) GTEST_SKIP() << "the other GPU is taken";
  EXPECT_THROW(engine->match({pair.reference, pair.target, nullptr, 6}, MatcherOptions{}, maps), Error);
  ROADSTEREO_CUDA(cudaSetDevice(0));
  engine->match({pair.reference, pair.target, nullptr, 6}, MatcherOptions{}, maps);
  EXPECT_EQ(maps.target_winner.width(), 40);
}

/// Tiny, for the thread sanitizer.
TEST_F(CudaMatching, TwoEnginesInTwoThreadsAreIndependent) {
  const auto match = [](std::uint64_t seed) {
    const auto pair = test::textured_pair(
        40, 34, [](double, double) { return 3; }, seed);
    MatcherOptions options;
    options.aggregation_radius = 2;
    MatchMaps maps;
    make_engine("cuda", 1)->match({pair.reference, pair.target, nullptr, 6}, options, maps);
    return maps.winner;
  };
  Image<std::int16_t> first, second;
  std::thread beside([&] { first = match(1); });
  second = match(2);
  beside.join();
  EXPECT_EQ(first, match(1));
  EXPECT_EQ(second, match(2));
}

TEST_F(CudaPipeline, RejectsWhatHostRejects) {
  const synth::SyntheticPair pair = frame_of("uav");
  Frame grey = pair.left;
  std::fill(grey.bytes.begin(), grey.bytes.end(), std::uint8_t{90});
  const auto refusal = [&](const std::string& engine, const Frame& left, const Frame& right) -> std::string {
    Pipeline pipeline(options_of("default", engine), pair.calibration);
    try {
      pipeline.process(left.view(), right.view());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("cpu", grey, pair.right), "");
  EXPECT_EQ(refusal("cuda", grey, pair.right), refusal("cpu", grey, pair.right));
  EXPECT_EQ(refusal("cuda", pair.left, grey), refusal("cpu", pair.left, grey));
  EXPECT_EQ(refusal("cuda", pair.left, pair.left), refusal("cpu", pair.left, pair.left));
  EXPECT_EQ(refusal("cuda", pair.right, pair.left), refusal("cpu", pair.right, pair.left));
  Frame small = pair.left;
  small.height = 20;
  EXPECT_EQ(refusal("cuda", small, small), refusal("cpu", small, small));
  Frame empty = pair.left;
  empty.bytes.clear();
  empty.bytes.shrink_to_fit();
  EXPECT_EQ(refusal("cuda", empty, pair.right), refusal("cpu", empty, pair.right));
  Pipeline host(options_of("default", "cpu"));
  EXPECT_THROW(host.set_device_options({}), Error);
}

TEST_F(CudaPipeline, ContinuesAfterRejectedFrame) {
  const synth::SyntheticPair pair = frame_of("uav");
  Pipeline pipeline(options_of("fast", "cuda"), pair.calibration), fresh(options_of("fast", "cuda"), pair.calibration);
  EXPECT_THROW(pipeline.process(pair.left.view(), pair.left.view()), Error);
  EXPECT_THROW(pipeline.device_maps(), Error);
  const Image<float> after = pipeline.process(pair.left.view(), pair.right.view()).disparity;
  const Image<float> expected = fresh.process(pair.left.view(), pair.right.view()).disparity;
  EXPECT_EQ(std::memcmp(after.row(0), expected.row(0), after.pixels() * sizeof(float)), 0);
}

TEST_F(CudaPipelineTwoGpus, UsesItsOwnDevice) {
  int devices = 0;
  ROADSTEREO_CUDA(cudaGetDeviceCount(&devices));
  if (devices < 2) GTEST_SKIP() << "there is one GPU";
  const synth::SyntheticPair pair = frame_of("uav", 0, 2);
  Pipeline pipeline(options_of("fast", "cuda"), pair.calibration);
  if (cudaSetDevice(1) != cudaSuccess) GTEST_SKIP() << "the other GPU is taken";
  EXPECT_THROW(pipeline.process(pair.left.view(), pair.right.view()), Error);
  ROADSTEREO_CUDA(cudaSetDevice(0));
  EXPECT_TRUE(pipeline.process(pair.left.view(), pair.right.view()).roll_found);
}

TEST_F(CudaPipelineTwoGpus, RejectsFramesOfOtherGpu) {
  int devices = 0;
  ROADSTEREO_CUDA(cudaGetDeviceCount(&devices));
  if (devices < 2) GTEST_SKIP() << "there is one GPU";
  const synth::SyntheticPair pair = frame_of("uav", 0, 2);
  Pipeline pipeline(options_of("fast", "cuda"), pair.calibration);
  if (cudaSetDevice(1) != cudaSuccess) GTEST_SKIP() << "the other GPU is taken";
  const cuda::DeviceArray<std::uint8_t> left = test::to_device(pair.left.bytes),
                                        right = test::to_device(pair.right.bytes);
  ROADSTEREO_CUDA(cudaSetDevice(0));
  FrameView left_view = pair.left.view(), right_view = pair.right.view();
  left_view.data = left.data();
  right_view.data = right.data();
  try {
    pipeline.process(left_view, right_view);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("memory of GPU 1"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(pipeline.process(pair.left.view(), pair.right.view()).roll_found);
}

TEST_F(CudaPipeline, WithoutRoadDisparityIsComplete) {
  // No calibration and noise for a picture: no road model, the host's search for a plane after matching.
  PipelineOptions options = options_of("default", "cuda");
  options.perspective.enabled = false;
  options.perspective.disparities = 40;
  const synth::SyntheticPair pair = frame_of("street");
  Pipeline device(options, pair.calibration);
  options.engine = "cpu";
  Pipeline host(options, pair.calibration);
  const FrameResult& found = device.process(pair.left.view(), pair.right.view());
  const FrameResult& expected = host.process(pair.left.view(), pair.right.view());
  EXPECT_GE(Difference(expected.disparity, found.disparity).same_share, 0.98);
  EXPECT_NEAR(found.valid_share, expected.valid_share, 5e-3);
}

#if defined(ROADSTEREO_CUDA_EMULATED)
/// Whichever launch of a following frame fails: nothing is in flight when the exception leaves, and the frame after it
/// has the bits that it would have had.
TEST_F(SlowCudaPipeline, FailedLaunchLeavesNothingBehind) {
  const synth::SyntheticPair pair = frame_of("uav", 0, 2), next = frame_of("uav", 1, 2);
  Pipeline pipeline(options_of("default", "cuda"), pair.calibration);
  pipeline.process(pair.left.view(), pair.right.view());
  const PipelineState carried = pipeline.carried();
  FrameResult expected, found;
  pipeline.process(next.left.view(), next.right.view(), expected);
  ASSERT_EQ(expected.road.status, RoadStatus::tracked);
  const auto same_bits = [](const Image<float>& a, const Image<float>& b) {
    return std::memcmp(a.row(0), b.row(0), a.pixels() * sizeof(float)) == 0;
  };
  int launches = 0;
  for (bool failed = true; failed; ++launches) {
    pipeline.restore(carried);
    cuda::emulated::fail_after(launches);
    failed = false;
    try {
      pipeline.process(next.left.view(), next.right.view(), found);
    } catch (const std::runtime_error&) {
      failed = true;
      EXPECT_EQ(cuda::emulated::streams_with_copies(), 0) << launches;
      EXPECT_THROW(pipeline.device_maps(), Error);
    }
    cuda::emulated::fail_after(-1);
    pipeline.restore(carried);
    pipeline.process(next.left.view(), next.right.view(), found);
    EXPECT_TRUE(same_bits(found.disparity, expected.disparity)) << launches;
    EXPECT_TRUE(same_bits(found.sigma, expected.sigma)) << launches;
    EXPECT_TRUE(same_bits(found.transformed, expected.transformed)) << launches;
    EXPECT_EQ(found.valid_share, expected.valid_share) << launches;
    EXPECT_EQ(found.geometry.roll_rad, expected.geometry.roll_rad) << launches;
    EXPECT_EQ(found.spread.sigma_road_px, expected.spread.sigma_road_px) << launches;
  }
  EXPECT_GT(launches, 15);
}

TEST_F(SlowCudaPipeline, AllocatesNothingAfterFirstFrames) {
  for (const std::string& name : preset_names()) {
    const synth::SyntheticPair pair = frame_of("uav");
    Pipeline pipeline(options_of(name, "cuda"), pair.calibration);
    for (int frame = 0; frame < 2; ++frame) pipeline.process(pair.left.view(), pair.right.view());
    const std::size_t before = cuda::emulated::allocations();
    const synth::SyntheticPair next = frame_of("uav", 1);
    pipeline.process(next.left.view(), next.right.view());
    EXPECT_EQ(cuda::emulated::allocations(), before) << name;
  }
}
#endif

}  // namespace
}  // namespace roadstereo
