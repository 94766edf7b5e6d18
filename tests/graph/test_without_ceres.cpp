// A build without Ceres says what it needs.
#include <gtest/gtest.h>

#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {
namespace {

TEST(PoseGraphWithoutCeres, NamesThePackage) {
  EXPECT_FALSE(has_pose_graph());
  try {
    optimise_poses({});
    FAIL() << "there is no Ceres";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("libceres-dev"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace roadstereo
