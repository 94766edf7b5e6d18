// Trajectories as text.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "roadstereo/io/trajectory_file.hpp"

namespace roadstereo::io {
namespace {

/// Frame 7: turned by an angle about the unit vector (2, 1, −2) / 3; at (1, −2, 0.1).
Trajectory turned(double angle) {
  const double s = std::sin(angle), c = std::cos(angle), k = 1 - c;
  const double x = 2.0 / 3, y = 1.0 / 3, z = -2.0 / 3;
  FramePose pose;
  pose.frame = 7;
  pose.camera_to_world = {c + x * x * k,     x * y * k - z * s, x * z * k + y * s, 1,
                          x * y * k + z * s, c + y * y * k,     y * z * k - x * s, -2,
                          x * z * k - y * s, y * z * k + x * s, c + z * z * k,     0.1};
  return {{pose}};
}

TEST(WriteTrajectory, ReaderGetsSameNumbers) {
  const Trajectory trajectory = turned(0.4);
  const std::string path = testing::TempDir() + "written_trajectory.txt";
  std::ofstream(path) << kitti_trajectory(trajectory, 0);
  const Trajectory again = read_trajectory(path);
  ASSERT_EQ(again.frames.size(), 1U);
  EXPECT_EQ(again.frames[0].frame, 7);
  EXPECT_EQ(again.frames[0].camera_to_world, trajectory.frames[0].camera_to_world);
}

TEST(WriteTrajectory, OnePiece) {
  Trajectory trajectory = turned(0);
  FramePose pose;
  pose.piece = 1;
  for (pose.frame = 8; pose.frame < 10; ++pose.frame) trajectory.frames.push_back(pose);
  EXPECT_EQ(longest_piece(trajectory), 1);
  const std::string text = kitti_trajectory(trajectory, 1);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_EQ(text.rfind("nan nan", 0), 0U);
  EXPECT_EQ(tum_trajectory(trajectory, 0, {}).find("\n8 "), std::string::npos);
  EXPECT_EQ(longest_piece({}), 0);
}

TEST(WriteTrajectory, TumHasQuaternion) {
  for (const double angle : {0.0, 0.4, 2.0, 3.1, -3.1}) {
    std::istringstream text(tum_trajectory(turned(angle), 0, {12.5}));
    std::string comment;
    std::getline(text, comment);
    std::array<double, 8> v{};
    for (double& value : v) text >> value;
    const double sine = std::sin(angle / 2);
    const std::array expected{12.5, 1.0, -2.0, 0.1, 2 * sine / 3, sine / 3, -2 * sine / 3, std::cos(angle / 2)};
    for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], expected[i], 1e-12) << angle << " " << i;
  }
}

TEST(WriteTrajectory, TumWithoutTimesHasIndex) {
  for (const std::vector<double>& times : {std::vector<double>{}, std::vector<double>{NAN}}) {
    EXPECT_NE(tum_trajectory(turned(0), 0, times).find("\n7 1 -2 0.1 0 0 0 1\n"), std::string::npos);
  }
}

// Another piece has no say in it.
TEST(WriteTrajectory, TumHasTimesOfAllFramesOrNone) {
  Trajectory trajectory = turned(0);
  FramePose pose = trajectory.frames[0];
  pose.frame = 8;
  trajectory.frames.push_back(pose);
  pose.frame = 9;
  pose.piece = 1;
  trajectory.frames.push_back(pose);
  const std::string timed = tum_trajectory(trajectory, 0, {12.5, 13.5, NAN});
  EXPECT_NE(timed.find("\n12.5 1 "), std::string::npos) << timed;
  EXPECT_NE(timed.find("\n13.5 1 "), std::string::npos) << timed;
  const std::string untimed = tum_trajectory(trajectory, 0, {12.5, NAN, 14.5});
  EXPECT_NE(untimed.find("\n7 1 "), std::string::npos) << untimed;
  EXPECT_NE(untimed.find("\n8 1 "), std::string::npos) << untimed;
}

}  // namespace
}  // namespace roadstereo::io
