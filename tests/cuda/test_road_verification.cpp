// The last frame's road on the next frame: the device's verification against verify_road_model(), on rendered flights.

#include <gtest/gtest.h>

#include <cmath>

#include "core/cuda/launch.hpp"
#include "road/cuda/road_verification.hpp"
#include "road/cuda/verification_assessment.hpp"
#include "road/road_search.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo::cuda {
namespace {

struct Pair {
  GreyImage left, right;
  DisparityPlane plane;
  std::optional<StereoCalibration> calibration;
};

synth::Scene road_scene(int width, int height) {
  synth::Scene scene = synth::named_scene("uav");
  scene.supersampling = 1;
  scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
  return scene;
}

Pair render_pair(const synth::Scene& scene) {
  const synth::SyntheticPair truth = synth::render(scene);
  Pair pair{{}, {}, truth.plane, truth.calibration};
  to_grey(truth.left.view(), 0, pair.left);
  to_grey(truth.right.view(), 0, pair.right);
  return pair;
}

constexpr double last_share = 0.8;  ///< of the samples that the road explained in the last frame

RoadModelEstimate verify_on_device(RoadVerification& verification, const Pair& pair, const DisparityPlane& previous,
                                   const RoadModelOptions& options) {
  test::DevicePlane<std::int16_t> left(pair.left), right(pair.right);
  verification.run(left.view(), right.view(), {nullptr, {previous.a0, previous.a1, previous.a2}}, options.with_roll,
                   nullptr);
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  return assess_road_verification(verification.statistics(), {previous, last_share}, pair.left.width(),
                                  pair.left.height(), pair.calibration, options);
}

void expect_same(const RoadModelEstimate& device, const RoadModelEstimate& host, const Pair& pair) {
  EXPECT_EQ(device.has_road(), host.has_road());
  EXPECT_EQ(device.reason, host.reason);
  EXPECT_EQ(device.status, host.status);
  EXPECT_NEAR(device.matches, host.matches, test::kernels_round_as_host ? 0 : 2);
  EXPECT_NEAR(device.inliers, host.inliers, test::kernels_round_as_host ? 1 : 3);
  // One point more in some hundred moves order statistics and planes.
  const bool same_points = device.matches == host.matches && device.inliers == host.inliers;
  const double looser = test::kernels_round_as_host || same_points ? 1 : 100;
  EXPECT_NEAR(device.correlation, host.correlation, looser * 1e-4);
  EXPECT_NEAR(device.residual_px, host.residual_px, looser * 1e-5);
  EXPECT_NEAR(device.residual_p01_px, host.residual_p01_px, looser * 1e-4);
  EXPECT_NEAR(device.residual_p99_px, host.residual_p99_px, looser * 1e-4);
  for (const double v : {0.0, pair.left.height() - 1.0}) {
    for (const double u : {0.0, pair.left.width() - 1.0}) {
      EXPECT_NEAR(device.model.disparity(u, v), host.model.disparity(u, v), looser * 1e-4);
    }
  }
}

class CudaRoadVerification : public test::OnDevice {
 protected:
  void expect_agreement(const Pair& pair, const DisparityPlane& previous, const RoadModelOptions& options = {}) {
    const RoadModelEstimate device = verify_on_device(*verification_, pair, previous, options);
    host_ = verify_road_model(pair.left, pair.right, {previous, last_share}, pair.calibration, options, 1);
    expect_same(device, host_, pair);
  }

  test::MadeOnUse<RoadVerification> verification_;  ///< used again for frames of every size
  RoadModelEstimate host_;
};

TEST_F(CudaRoadVerification, FlightMatchesHost) {
  const synth::Scene scene = road_scene(208, 117);
  synth::FlightPath path;
  path.roll_period = path.pitch_period = path.climb_period = 40;
  DisparityPlane previous = render_pair(synth::flight_frame(scene, path, 0)).plane;
  expect_agreement(render_pair(synth::flight_frame(scene, path, 1)), previous);
  EXPECT_TRUE(host_.has_road()) << host_.reason;
  previous = host_.model;
  RoadModelOptions strict;
  strict.with_roll = false;
  strict.verify_tolerance_px = 1e-4;
  expect_agreement(render_pair(synth::flight_frame(scene, path, 2)), previous, strict);
  EXPECT_NE(host_.reason.find("residual"), std::string::npos) << host_.reason;
  EXPECT_EQ(host_.model.a2, 0);
}

TEST_F(CudaRoadVerification, NoiseIsThatOfHost) {
  synth::Scene scene = road_scene(208, 117);
  const DisparityPlane previous = render_pair(scene).plane;
  for (const double noise_grey : {2.0, 5.0}) {
    scene.degradation.noise_grey = noise_grey;
    expect_agreement(render_pair(scene), previous);
    EXPECT_EQ(host_.status, RoadStatus::tracked) << host_.reason;
  }
  EXPECT_LT(host_.correlation, 0.9);
  EXPECT_GT(host_.correlation, 0.3);
}

TEST_F(CudaRoadVerification, JumpHasReasonOfHost) {
  synth::Scene scene = road_scene(208, 117);
  const DisparityPlane previous = render_pair(scene).plane;
  scene.rig.camera_height_m *= 0.5;  // nothing of the road within the search
  expect_agreement(render_pair(scene), previous);
  EXPECT_FALSE(host_.has_road());
  scene.rig.camera_height_m *= 1.8;  // a little lower than at first: still within the search
  expect_agreement(render_pair(scene), previous);
  EXPECT_EQ(host_.status, RoadStatus::tracked) << host_.reason;
}

TEST_F(CudaRoadVerification, UnrelatedImagesAreUnreliable) {
  Pair pair = render_pair(road_scene(208, 117));
  const DisparityPlane road = pair.plane;
  pair.right = test::textured_pair(
                   208, 117, [](double, double) { return 0; }, 99)
                   .target;
  expect_agreement(pair, road);
  EXPECT_NE(host_.reason.find("only 0 correspondences"), std::string::npos) << host_.reason;
  EXPECT_EQ(verification_->statistics().close.tried, 0);
}

TEST_F(CudaRoadVerification, RepetitionIsIdenticalWithoutAllocation) {
  const DisparityPlane plane{6, 0.06, -0.03};
  const auto images = test::textured_pair(161, 93, [&](double u, double v) { return plane.disparity(u, v); });
  const test::DevicePlane<std::int16_t> left(images.reference.view()), right(images.target.view());
  VerificationStatistics first{};
  for (const int again : {0, 1}) {
#if defined(ROADSTEREO_CUDA_EMULATED)
    const std::size_t before = emulated::allocations();
#endif
    verification_->run(left.view(), right.view(), {nullptr, {6.3, 0.06, -0.031}}, true, nullptr);
    ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
#if defined(ROADSTEREO_CUDA_EMULATED)
    EXPECT_EQ(emulated::allocations() > before, again == 0);
#endif
    const VerificationStatistics& statistics = verification_->statistics();
    if (again == 0) first = statistics;
    EXPECT_EQ(statistics.close.found, 1);
    EXPECT_EQ(statistics.close.fit.plane.a0, first.close.fit.plane.a0);
    EXPECT_EQ(statistics.close.fit.plane.a1, first.close.fit.plane.a1);
    EXPECT_EQ(statistics.close.fit.plane.a2, first.close.fit.plane.a2);
    EXPECT_EQ(statistics.close.fit.scale_px, first.close.fit.scale_px);
    EXPECT_EQ(statistics.close.inliers, first.close.inliers);
    EXPECT_EQ(statistics.residual_p01_px, first.residual_p01_px);
  }
}

TEST_F(CudaRoadVerification, SmallAndLargeImagesMatchHost) {
  const auto small = test::textured_pair(32, 32, [](double, double) { return 4; });
  expect_agreement({small.reference, small.target, {}, std::nullopt}, {4, 0, 0});
  // Wide enough to be searched at half its size.
  const DisparityPlane plane{11, 0.4, 0.002};
  const auto large = test::textured_pair(1921, 64, [&](double u, double v) { return plane.disparity(u, v); });
  ASSERT_EQ(fine_factor(1921), 2);
  const Pair pair{large.reference, large.target, plane, std::nullopt};
  expect_agreement(pair, {11.6, 0.39, 0.002});
  EXPECT_TRUE(host_.has_road()) << host_.reason;
}

}  // namespace
}  // namespace roadstereo::cuda
