// `benchmark` from outside.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/parallel.hpp"
#include "roadstereo/matcher.hpp"
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

// With oneTBB no more than there are cores.
TEST_F(BenchmarkCommand, ThreadsAreThoseOfPipeline) {
  const Outcome outcome = run("benchmark --size 96x64 --disparities 16 --runs 1 --no-peers --threads 64 --json a.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("a.json")["threads"], resolve_threads(64));
}

TEST_F(BenchmarkCommand, TakesPairOfFiles) {
  make_road();
  const Outcome outcome =
      run("benchmark road/left.png road/right.png --calibration road/calibration.yaml --runs 1 --no-peers");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("SGBM"), std::string::npos);
}

TEST_F(BenchmarkCommand, ComparesWithOpenCvOnPairAsItIs) {
  make_road();
  const Outcome outcome =
      run("benchmark road/left.png road/right.png --calibration road/calibration.yaml --disparities 0 "
          "--raw-disparities 64 --runs 1 --json figures.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("OpenCV, D 64"), std::string::npos) << outcome.out;
  const auto figures = nlohmann::json::parse(read_text(folder_ / "figures.json"));
  EXPECT_EQ(figures["raw_disparities"], 64);
  EXPECT_LT(figures["disparities"], 64);
  EXPECT_EQ(figures["peers"].size(), 4U);
}

/// What the device was asked for stands in the text and in JSON.
TEST_F(BenchmarkCommand, DescribesKernelsOfDevice) {
  const auto& all = engines();
  if (std::none_of(all.begin(), all.end(), [](const EngineInfo& engine) { return engine.name == "cuda"; })) {
    GTEST_SKIP() << "there is no GPU, nor are kernels emulated";
  }
  const Outcome outcome =
      run("benchmark --engine cuda --size 96x64 --disparities 16 --runs 1 --no-peers --json figures.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("pair_to_grey"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" 2 waits, "), std::string::npos) << outcome.out;
  const auto device = nlohmann::json::parse(read_text(folder_ / "figures.json"))["device"];
  EXPECT_EQ(device["waits"], 2);
  EXPECT_EQ(device["bytes_up"], 2 * 96 * 64);
  EXPECT_EQ(device["bytes_down"], 16 * 96 * 64);
  int launches = 0;
  for (const auto& kernel : device["kernels"]) {
    launches += kernel["launches"].get<int>();
    EXPECT_GT(kernel["occupancy"], 0) << kernel;
    EXPECT_GT(kernel["blocks"], 0) << kernel;
    for (const char* field : {"ms", "threads", "registers", "local_bytes", "shared_bytes"}) {
      EXPECT_TRUE(kernel[field].is_number()) << field << ": " << kernel;
    }
  }
  EXPECT_EQ(device["launches"], launches);
  EXPECT_GT(launches, 15);
}

TEST_F(BenchmarkCommand, FileIsTriedBeforeMeasurement) {
  const std::string benchmark = "benchmark --size 96x64 --disparities 16 --runs 1 --no-peers --json ";
  expect_complaint(run(benchmark + "none/a.json"), "cannot write none/a.json: No such file or directory");
  const Outcome full = run(benchmark + "/dev/full");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.out.find("total"), std::string::npos) << full.out;
  EXPECT_NE(full.err.find("cannot write /dev/full: No space left on device"), std::string::npos) << full.err;
}

TEST_F(BenchmarkCommand, RejectsBadInput) {
  expect_complaint(run("benchmark --size 640"), 2, "640x360");
  expect_complaint(run("benchmark --runs 0"), 2, "--runs");
  expect_complaint(run("benchmark left.png"), 2, "LEFT and RIGHT");
  expect_complaint(run("benchmark --preset slow"), 2, "slow");
  expect_complaint(run("benchmark --size 100x100 --raw-disparities 128"), 2, "128 disparities in 100 columns");
  expect_complaint(run("benchmark --size 100x100 --disparities 97"), 2, "112 disparities in 100 columns");
  expect_complaint(run("benchmark --raw-disparities -1"), 2, "--raw-disparities is -1");
}

}  // namespace
}  // namespace roadstereo
