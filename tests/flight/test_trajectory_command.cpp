// `inspect --trajectory` and `evaluate odometry` from outside, on a short flight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "roadstereo/io/trajectory_file.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class TrajectoryCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made = run("synth --scene uav --size 256x144 --frames 4 --flight default --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
};

TEST_F(TrajectoryCommand, FilesHaveMotion) {
  const std::string options = "--trajectory";  // flight/calibration.yaml is taken
  const Outcome outcome = run("inspect flight " + options + " --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("in 1 piece, 3 links (0 weak)"), std::string::npos) << outcome.out;
  const Trajectory trajectory = io::read_trajectory((folder_ / "out/trajectory_kitti.txt").string());
  ASSERT_EQ(trajectory.frames.size(), 4U);
  // Frame 3 is 0.3 m further along the road, and 2 mm higher: the flight's raised cosine with a period of 170 frames.
  const auto& pose = trajectory.frames[3].camera_to_world;
  EXPECT_NEAR(std::hypot(pose[3], pose[7], pose[11]), 0.3, 4e-3);  // a quarter of a pixel
  const std::string links = read_text(folder_ / "out/links.csv"), poses = read_text(folder_ / "out/trajectory.csv");
  EXPECT_EQ(std::count(links.begin(), links.end(), '\n'), 4);
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 5);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/trajectory.tum"));
  expect_complaint(run("inspect flight " + options + " --output out --resume"), "--trajectory cannot be resumed");
  std::filesystem::remove(folder_ / "flight/calibration.yaml");
  expect_complaint(run("inspect flight --trajectory --output other"), "--trajectory needs --calibration");
  expect_complaint(run("inspect flight/left/000000.png flight/right/000000.png --trajectory --output pair"),
                   "--trajectory is for recordings only");
}

}  // namespace
}  // namespace roadstereo
