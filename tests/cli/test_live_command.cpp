// `live` from outside: what it rejects.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

using LiveCommand = RoadCommandTest;

TEST_F(LiveCommand, RejectsBadOptions) {
  expect_complaint(run("live missing.mp4"), "missing.mp4");
  expect_complaint(run("live missing.mp4 --serve nonsense"), "--serve is \"nonsense\"");
  expect_complaint(run("live missing.mp4 --set nonsense=1"), "nonsense");
  expect_complaint(run("live missing.mp4 --layout sideways"), "sideways");
}

TEST_F(LiveCommand, NamesCameraSize) {
  expect_complaint(run("live missing.mp4 --camera-size wide"), "--camera-size must be WIDTHxHEIGHT");
}

TEST_F(LiveCommand, FailureComesAfterSummary) {
  ASSERT_EQ(run("synth --scene uav --frames 2 --flight default --size 160x90 --output flight --quiet").exit_code, 0);
  std::filesystem::remove(folder_ / "flight/calibration.yaml");
  const Outcome outcome = run("live flight --trajectory --json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--trajectory needs --calibration"), std::string::npos) << outcome.err;
  EXPECT_TRUE(nlohmann::json::parse(outcome.out, nullptr, false).is_object()) << outcome.out;
}

}  // namespace
}  // namespace roadstereo
