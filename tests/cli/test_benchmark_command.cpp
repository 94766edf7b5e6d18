// `benchmark` from outside.

#include <gtest/gtest.h>

#include <string>

#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

using BenchmarkCommand = RoadCommandTest;

TEST_F(BenchmarkCommand, MeasuresStagesAndOpenCv) {
  const Outcome outcome = run("benchmark --size 320x180 --disparities 16 --runs 2 --preset fast --json figures.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("SGBM"), std::string::npos);
  const auto figures = nlohmann::json::parse(read_text(folder_ / "figures.json"));
  EXPECT_EQ(figures["width"], 320);
  EXPECT_EQ(figures["disparities"], 16);
  EXPECT_EQ(figures["total"]["runs"], 2);
  EXPECT_EQ(figures["stages"].size(), 9U);
  EXPECT_EQ(figures["peers"].size(), 4U);
  double stages = 0;
  for (const auto& stage : figures["stages"]) stages += stage["min_ms"].get<double>();
  EXPECT_LE(stages, figures["total"]["max_ms"].get<double>());
}

TEST_F(BenchmarkCommand, TakesPairOfFiles) {
  make_road();
  const Outcome outcome =
      run("benchmark road/left.png road/right.png --calibration road/calibration.yaml --runs 1 --no-peers");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("SGBM"), std::string::npos);
}

TEST_F(BenchmarkCommand, RejectsBadInput) {
  expect_complaint(run("benchmark --size 640"), 2, "640x360");
  expect_complaint(run("benchmark --runs 0"), 2, "--runs");
  expect_complaint(run("benchmark left.png"), 2, "LEFT and RIGHT");
  expect_complaint(run("benchmark --preset slow"), 2, "slow");
}

}  // namespace
}  // namespace roadstereo
