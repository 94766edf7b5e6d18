// Peers of the odometry: OpenCV's on rendered frames; programs of others, played by scripts, for what is read from
// them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "evaluation/peer_odometry.hpp"
#include "evaluation/peer_programs.hpp"
#include "evaluation/peer_rgbd.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

/// A frame `ahead_m` along the road, with its exact disparities.
struct RenderedFrame {
  GreyImage grey;
  Image<float> disparity;
  StereoCalibration calibration;

  explicit RenderedFrame(double ahead_m) {
    synth::Scene scene = synth::named_scene("street");
    scene.rig.focal_px *= 320.0 / scene.rig.width;
    scene.rig.width = 320;
    scene.rig.height = 180;
    scene.supersampling = 1;
    scene.rig.y_m += ahead_m;
    const synth::SyntheticPair pair = synth::render(scene);
    calibration = pair.calibration;
    to_grey(pair.left.view(), 0, grey);
    disparity.resize(320, 180);
    for (int v = 0; v < 180; ++v) {
      for (int u = 0; u < 320; ++u) disparity(u, v) = static_cast<float>(pair.disparity(u, v));
    }
  }
};

TEST(RgbdOdometry, MovesAsCameraDoes) {
  const RenderedFrame first(0), second(0.1);
  if (!RgbdOdometry::available()) {
    EXPECT_THROW(RgbdOdometry{first.calibration}, Error);
    GTEST_SKIP() << "SKIPPED: this OpenCV has no module rgbd";
  }
  RgbdOdometry odometry(first.calibration);
  EXPECT_FALSE(odometry.add(first.grey, first.disparity).has_value());
  const auto motion = odometry.add(second.grey, second.disparity);
  ASSERT_TRUE(motion.has_value());
  // 0.1 m along the road, which the camera sees at its pitch.
  EXPECT_NEAR(std::hypot((*motion)[3], (*motion)[7], (*motion)[11]), 0.1, 0.02);
  EXPECT_LT((*motion)[11], 0);  // points come nearer
}

/// Programs in a folder of their own, which is all of PATH but for what scripts need.
class PeerPrograms : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("roadstereo_peers" + std::to_string(getpid()));
    fs::create_directories(folder_ / "bin");
    path_ = std::getenv("PATH");
    setenv("PATH", ((folder_ / "bin").string() + ":/usr/bin:/bin").c_str(), 1);
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }

  void add_program(const std::string& name, const std::string& script) const {
    const fs::path file = folder_ / "bin" / name;
    std::ofstream(file) << "#!/bin/sh\n" << script;
    fs::permissions(file, fs::perms::owner_all);
  }

  PeerFrames frames(int count) const {
    PeerFrames frames(folder_ / "frames", {.focal_px = 100, .cx_px = 15.5, .cy_px = 15.5, .baseline_m = 0.1});
    const GreyImage grey(32, 32, 1600);
    Image<float> disparity(32, 32, 10);
    disparity(0, 0) = NAN;
    for (int i = 0; i < count; ++i) frames.add(grey, disparity);
    return frames;
  }

  fs::path folder_;
  std::string path_;
};

std::string complaint(PeerPoses (*run)(const PeerFrames&), const PeerFrames& frames) {
  try {
    run(frames);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// A quarter turn about y and (1, 2, 3) from world to camera: the camera is at −Rᵀt = (3, −2, −1).
TEST_F(PeerPrograms, ReadsPosesOfColmap) {
  add_program("colmap", R"(for word in "$@"; do last=$word; done
case "$1" in
  mapper) mkdir -p "$PWD_OF/sparse/0" "$PWD_OF/sparse/1"; echo 1 >"$PWD_OF/sparse/0/images.bin"; echo 12345 >"$PWD_OF/sparse/1/images.bin" ;;
  model_converter) case "$5" in *sparse/1) ;; *) exit 3 ;; esac
    printf '# images\n1 0.70710678118654752 0 0.70710678118654752 0 1 2 3 1 000002.png\n10 20 -1\n2 1 0 0 0 0 0 -4 1 000000.png\n\n' >"$7/images.txt" ;;
esac
)");
  setenv("PWD_OF", (folder_ / "frames").c_str(), 1);
  const PeerPoses poses = run_colmap(frames(3));
  ASSERT_EQ(poses.camera_to_world.size(), 3U);
  EXPECT_FALSE(poses.camera_to_world[1].has_value());
  const std::array<double, 12> ahead{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4}, turned{0, 0, -1, 3, 0, 1, 0, -2, 1, 0, 0, -1};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(poses.camera_to_world[0]->at(i), ahead[i], 1e-12) << i;
    EXPECT_NEAR(poses.camera_to_world[2]->at(i), turned[i], 1e-12) << i;
  }
}

TEST_F(PeerPrograms, SaysWhyColmapFailed) {
  add_program("colmap", "echo some words; echo the reason; exit 1\n");
  EXPECT_NE(complaint(run_colmap, frames(3)).find("the reason"), std::string::npos);
  fs::remove(folder_ / "bin" / "colmap");
  if (std::system("command -v colmap >/dev/null") != 0) {
    EXPECT_EQ(complaint(run_colmap, frames(3)), "colmap is not in PATH (Debian's package colmap)");
  }
}

TEST_F(PeerPrograms, ChainsMotionsOfOpen3d) {
  add_program("python3", R"([ "$1" = -c ] && exit 0
echo some message of a library
echo 1 0 0 0 0 1 0 0 0 0 1 -0.5 0.25
echo nan nan nan nan nan nan nan nan nan nan nan nan 0.25
echo 0 0 1 0 0 1 0 0 -1 0 0 -1 0.5
)");
  const PeerPoses poses = run_open3d(frames(4));
  EXPECT_NEAR(poses.seconds, 1, 1e-12);
  ASSERT_EQ(poses.camera_to_world.size(), 4U);
  EXPECT_NEAR(poses.camera_to_world[1]->at(11), 0.5, 1e-12);
  EXPECT_FALSE(poses.camera_to_world[2].has_value());
  // x' = z and z' = −x − 1 from the camera at z = 0.5: the next one is at (−1, 0, 0.5).
  const std::array<double, 12> last{0, 0, -1, -1, 0, 1, 0, 0, 1, 0, 0, 0.5};
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(poses.camera_to_world[3]->at(i), last[i], 1e-12) << i;
}

TEST_F(PeerPrograms, SaysWhatOpen3dLacks) {
  add_program("python3", "exit 1\n");
  EXPECT_EQ(complaint(run_open3d, frames(2)), "python3 has no open3d (Debian's package python3-open3d)");
  add_program("python3", "exit 0\n");
  EXPECT_EQ(complaint(run_open3d, frames(3)), "open3d gave 0 motions of 3 frames");
}

}  // namespace
}  // namespace roadstereo::io
