// Trajectories as KITTI has them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/io/trajectory_file.hpp"

namespace roadstereo::io {
namespace {

std::string trajectory_file(const std::string& text) {
  const auto path =
      std::filesystem::temp_directory_path() / ("roadstereo_trajectory" + std::to_string(::getpid()) + ".txt");
  std::ofstream(path) << text;
  return path.string();
}

TEST(ReadTrajectory, ReadsPosesAndSkipsUnknownOnes) {
  const Trajectory trajectory =
      read_trajectory(trajectory_file("1 0 0 0 0 1 0 0 0 0 1 0\n"
                                      "nan nan nan nan nan nan nan nan nan nan nan nan\n"
                                      "0 -1 0 2.5 1 0 0 -3 0 0 1 1e-2\n"));
  ASSERT_EQ(trajectory.frames.size(), 2U);
  EXPECT_EQ(trajectory.frames[0].frame, 0);
  EXPECT_EQ(trajectory.frames[1].frame, 2);
  EXPECT_EQ(trajectory.frames[1].camera_to_world[3], 2.5);
  EXPECT_EQ(trajectory.frames[1].camera_to_world[4], 1);
  EXPECT_EQ(trajectory.frames[1].camera_to_world[11], 0.01);
}

TEST(ReadTrajectory, EmptyLinesAtTheEndAreNoPoses) {
  const std::string pose = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_EQ(read_trajectory(trajectory_file(pose + "\n \n\n")).frames.size(), 1U);
  EXPECT_THROW(read_trajectory(trajectory_file(pose + "\n" + pose)), Error) << "a line is the number of a frame";
}

TEST(ReadTrajectory, ReadsEveryFiniteNumber) {
  const Trajectory trajectory = read_trajectory(trajectory_file("+1 0 -0 4.9e-324 0 1e+00 0 1e300 0 0 1. -.5\n"));
  ASSERT_EQ(trajectory.frames.size(), 1U);
  EXPECT_EQ(trajectory.frames[0].camera_to_world[3], 4.9e-324);
  EXPECT_EQ(trajectory.frames[0].camera_to_world[7], 1e300);
  EXPECT_EQ(trajectory.frames[0].camera_to_world[11], -0.5);
}

void expect_error(const std::string& text, const std::string& part) {
  try {
    read_trajectory(trajectory_file(text));
    FAIL() << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(ReadTrajectory, NamesWhatIsWrong) {
  expect_error("", "no pose");
  expect_error("1 0 0 0 0 1 0 0 0 0 1\n", "line 1 has 11 numbers");
  expect_error("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 one 0\n", "line 2: \"one\" is no number");
  expect_error("1 0 0 0 0 1 0 0 0 0 0x1 0\n", "line 1: \"0x1\" is no number");
  expect_error("1 0 0 0 0 1 0 0 0 0 +-1 0\n", "line 1: \"+-1\" is no number");
  expect_error("2 0 0 0 0 1 0 0 0 0 1 0\n", "no rotation");
  expect_error("1 0 0 0 0 1 0 0 0 0 1 0\n0 1 0 0 1 0 0 0 0 0 1 0\n",
               "line 2: the first three columns are a reflection");
  EXPECT_THROW(read_trajectory("/nonexistent/poses.txt"), Error);
  EXPECT_THROW(read_trajectory(testing::TempDir()), SystemError) << "a folder can be opened, but not read";
}

}  // namespace
}  // namespace roadstereo::io
