// Rendered frames of one place, seen twice from poses that are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/loop_search.hpp"
#include "tests/odometry/known_frame.hpp"

namespace roadstereo {
namespace {

using test::known_frame;
using test::KnownFrame;

synth::Scene scene_at(double x_m, double y_m, double yaw_deg) {
  synth::Scene scene = test::smaller_scene("uav", 2);
  scene.degradation.noise_grey = 2;
  scene.degradation.noise_seed = static_cast<std::uint32_t>(1000 + 100 * y_m + yaw_deg);
  scene.rig.x_m += x_m;
  scene.rig.y_m += y_m;
  scene.rig.yaw_deg += yaw_deg;
  return scene;
}

/// A place, one far from it, and the place again: with this yaw, and this error of its pose.
class LoopSearchOfPlace : public testing::TestWithParam<double> {};

TEST_P(LoopSearchOfPlace, IsLinked) {
  const double yaw_deg = GetParam();
  const double y_m = std::abs(yaw_deg) > 90 ? 2.6 : 0.25;  // the camera looks ahead of its foot
  const std::vector<KnownFrame> frames{known_frame(scene_at(0, 0, 0)), known_frame(scene_at(0, 12, 0)),
                                       known_frame(scene_at(0.15, y_m, yaw_deg))};
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("roadstereo_loops_" + std::to_string(static_cast<int>(yaw_deg)));
  Trajectory trajectory;
  {
    LoopSearch search(scene_at(0, 0, 0).rig.calibration(), folder);
    for (int i = 0; i < 3; ++i) {
      const KnownFrame& frame = frames[static_cast<std::size_t>(i)];
      search.add(i, frame.maps());
      FramePose pose;
      pose.frame = i;
      RigidMotion known = frame.pose;
      if (i == 2) known.translation[0] += 0.08;
      pose.camera_to_world = matrix_of(known);
      for (std::size_t k = 0; k < 6; ++k) pose.covariance[7 * k] = i * (k < 3 ? 1e-3 : 1e-5);
      trajectory.frames.push_back(pose);
    }
    const std::vector<LoopLink> loops = search.find(trajectory, trajectory);
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_EQ(loops[0].link.from, 0);
    EXPECT_EQ(loops[0].link.to, 2);
    EXPECT_GT(loops[0].link.correlation, 0.5);
    const RigidMotion truth = inverse(frames[2].pose) * frames[0].pose;
    const RigidMotion error = motion_of(loops[0].link.motion) * inverse(truth);
    // What the middle of the image shows is off by less than a tenth of a pixel's side.
    const Vector<3> centre = loops[0].centre_m, moved = error(centre);
    EXPECT_LT(std::hypot(moved[0] - centre[0], moved[1] - centre[1]), 0.2 * loops[0].pixel_m);
    EXPECT_TRUE(search.find(trajectory, trajectory).empty());  // found already
    EXPECT_THROW(search.add(2, frames[2].maps()), Error);
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

INSTANTIATE_TEST_SUITE_P(Yaws, LoopSearchOfPlace, testing::Values(0, 25, 180));

/// The same cameras and disparities, counted from another zero: those of the road are negative.
TEST(LoopSearch, DisparityOffsetChangesNoLoop) {
  constexpr double offset_px = 40;
  std::vector<KnownFrame> frames{known_frame(scene_at(0, 0, 0)), known_frame(scene_at(0, 12, 0)),
                                 known_frame(scene_at(0.15, 0.25, 25))};
  Trajectory trajectory;
  for (const KnownFrame& frame : frames) {
    FramePose pose;
    pose.frame = static_cast<int>(trajectory.frames.size());
    pose.camera_to_world = matrix_of(frame.pose);
    for (std::size_t k = 0; k < 6; ++k) pose.covariance[7 * k] = pose.frame * (k < 3 ? 1e-3 : 1e-5);
    trajectory.frames.push_back(pose);
  }
  StereoCalibration calibration = scene_at(0, 0, 0).rig.calibration();
  const auto loops = [&] {
    LoopSearch search(calibration, std::filesystem::path(testing::TempDir()) / "roadstereo_other_zero");
    for (int i = 0; i < 3; ++i) search.add(i, frames[static_cast<std::size_t>(i)].maps());
    return search.find(trajectory, trajectory);
  };
  const std::vector<LoopLink> usual = loops();
  calibration.disparity_offset_px = offset_px;
  for (KnownFrame& frame : frames) {
    std::transform(frame.disparity.row(0), frame.disparity.row(0) + frame.disparity.pixels(), frame.disparity.row(0),
                   [](float d) { return d - static_cast<float>(offset_px); });
    frame.plane.a0 -= offset_px;
  }
  const std::vector<LoopLink> other = loops();
  ASSERT_EQ(usual.size(), 1U);
  ASSERT_EQ(other.size(), 1U);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(other[0].link.motion[k], usual[0].link.motion[k], 1e-5) << k;
}

TEST(LoopSearch, PlaceThatIsNeverLeftHasNoLoop) {
  const KnownFrame frame = known_frame(scene_at(0, 0, 0));
  LoopSearch search(scene_at(0, 0, 0).rig.calibration(),
                    std::filesystem::path(testing::TempDir()) / "roadstereo_still");
  Trajectory trajectory;
  for (int i = 0; i < 4; ++i) {
    search.add(i, frame.maps());
    FramePose pose;
    pose.frame = i;
    pose.camera_to_world = matrix_of(frame.pose);
    trajectory.frames.push_back(pose);
  }
  EXPECT_TRUE(search.find(trajectory, trajectory).empty());
  EXPECT_EQ(search.compared(), 0U);
}

TEST(LoopSearch, RefusesWhatIsNotItsOwn) {
  const KnownFrame frame = known_frame(scene_at(0, 0, 0));
  const StereoCalibration calibration = scene_at(0, 0, 0).rig.calibration();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "roadstereo_not_loops";
  std::filesystem::create_directories(folder / "notes");
  EXPECT_THROW(LoopSearch(calibration, folder), Error);
  EXPECT_TRUE(std::filesystem::exists(folder / "notes"));
  std::filesystem::remove(folder / "notes");
  LoopSearch search(calibration, folder);
  search.add(0, frame.maps());
  EXPECT_THROW(search.add(1, known_frame(test::smaller_scene("uav", 3)).maps()), Error);
  search.add(1, frame.maps());
  EXPECT_THROW(search.find({}, {}), Error);
}

}  // namespace
}  // namespace roadstereo
