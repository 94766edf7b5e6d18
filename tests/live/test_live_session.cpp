// A live run from its source to its end, with all of its threads.

#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "calibration_yaml.hpp"
#include "live/live_command.hpp"
#include "live/live_session.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "tests/live/live_test.hpp"

namespace roadstereo::cli {
namespace {

using namespace std::chrono_literals;
using LiveSessionFiles = LiveFiles;

/// A session to its end.
LiveStatus run_session(const LiveOptions& options, const MemoryPlan& plan) {
  LiveSession session(options, [&plan] { return source_of(plan); });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  session.end();
  return session.board().status();
}

TEST(LiveSession, CountsEveryPair) {
  LiveOptions options;
  options.max_age_s = 1000;
  const LiveStatus status = run_session(options, {12, 0.01, false, "", 11});
  const LiveCounts& counts = status.counts;
  EXPECT_EQ(counts.taken, 12);
  EXPECT_EQ(counts.taken, counts.shown + counts.dropped + counts.too_old + counts.rejected);
  EXPECT_EQ(counts.rejected, 1);
  EXPECT_GE(counts.shown, 1);
  ASSERT_TRUE(status.view);
  EXPECT_EQ(status.view->left.width, 320);
  EXPECT_EQ(status.view->transformed.width(), 320);
  EXPECT_EQ(status.view->ids.height(), 180);
  EXPECT_EQ(status.view->number, counts.shown);
}

TEST(LiveSession, SkipsOldPairs) {
  LiveOptions options;
  options.max_age_s = 1e-9;
  const LiveCounts counts = run_session(options, {5, 0.001, false, "", -1}).counts;
  EXPECT_EQ(counts.shown, 0);
  EXPECT_GE(counts.too_old, 1);
  EXPECT_EQ(counts.taken, counts.too_old + counts.dropped);
}

TEST(LiveSession, CountsRejectedPairs) {
  LiveOptions options;
  auto frames = std::make_shared<std::vector<PairOfFrames>>(*small_flight().frames);
  for (PairOfFrames& pair : *frames) pair.second = pair.first;
  LiveSession session(options, [&frames] {
    return std::make_unique<MemorySource>(frames, MemoryPlan{2, 0.5, false, "", -1});
  });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  session.stop();  // finishes the pairs that were read
  EXPECT_NE(session.board().status().message.find("same image"), std::string::npos);
  session.end();
  EXPECT_EQ(session.board().status().counts.rejected, 2);
}

TEST_F(LiveSessionFiles, UnstartedSessionLeavesNoRecording) {
  LiveOptions options;
  options.record = (folder_ / "rec").string();
  {
    const LiveSession session(options, [] { return source_of({1, 0.001, false, "", -1}); });
  }
  EXPECT_TRUE(files_in(folder_).empty());
}

/// `inspect` of the recording finds what `live` was given, under whatever name, in one file or in two.
TEST_F(LiveSessionFiles, RecordsCalibrationWithPairs) {
  io::StereoRig rig;
  rig.left_matrix = {700.5, 0, 320.25, 0, 701.5, 180.75, 0, 0, 1};
  rig.right_matrix = {702.5, 0, 318.25, 0, 703.5, 178.75, 0, 0, 1};
  rig.left_distortion = {-0.1, 0.02, 0.001, -0.002, 0.003};
  rig.right_distortion = {-0.2, 0.03, 0.002, -0.001, 0.004};
  rig.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  rig.translation_m = {-0.12, 0.001, -0.002};
  rig.width = 640;
  rig.height = 360;
  const std::string text = opencv_yaml(rig);
  const std::size_t poses = text.find("R: ");
  write("rig.yaml", text);
  write("intrinsics.yml", text.substr(0, poses));
  write("extrinsics.yml", "%YAML:1.0\n---\n" + text.substr(poses));
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  for (const std::vector<std::string>& files :
       {std::vector{path("rig.yaml")}, std::vector{path("intrinsics.yml"), path("extrinsics.yml")}}) {
    LiveOptions options;
    options.calibration = files;
    options.record = path("rec");
    const LiveSession session(options, [] { return source_of({1, 0.001, false, "", -1}); });
    const io::CalibrationFile recorded = io::read_calibration(path("rec/calibration.yaml"));
    ASSERT_TRUE(recorded.rig);
    EXPECT_EQ(recorded.rig->left_matrix, rig.left_matrix);
    EXPECT_EQ(recorded.rig->right_matrix, rig.right_matrix);
    EXPECT_EQ(recorded.rig->left_distortion, rig.left_distortion);
    EXPECT_EQ(recorded.rig->right_distortion, rig.right_distortion);
    EXPECT_EQ(recorded.rig->translation_m, rig.translation_m);
    EXPECT_FALSE(recorded.rig->fisheye);
    EXPECT_EQ(recorded.rig->width, 640);
  }
}

TEST(CalibrationYaml, KeepsDisparityOffset) {
  StereoCalibration calibration = small_flight().calibration;
  calibration.disparity_offset_px = 12.5;
  const auto file = std::filesystem::temp_directory_path() / ("roadstereo-offset-" + std::to_string(::getpid()));
  std::ofstream(file) << plain_yaml(calibration);
  const auto read = io::read_calibration(file.string()).rectified;
  std::filesystem::remove(file);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->disparity_offset_px, 12.5);
  EXPECT_EQ(read->focal_px, calibration.focal_px);
}

TEST_F(LiveSessionFiles, FollowsCamera) {
  write("rig.yaml", plain_yaml(small_flight().calibration));
  LiveOptions options;
  options.max_age_s = 1000;
  options.calibration = {(folder_ / "rig.yaml").string()};
  options.processing.trajectory = true;
  LiveSession session(options, [] { return source_of({100000, 0.05, false, "", -1}); });
  session.start();
  SharedPath path;
  for (int wait = 0; wait < 60000 && !(path && path->length_m > 0); ++wait) {  // on a busy machine most are skipped
    std::this_thread::sleep_for(1ms);
    path = session.board().status().path;
  }
  session.end();
  ASSERT_TRUE(path);
  EXPECT_EQ(path->pieces, 1);
  EXPECT_GE(path->points_m.size(), 2U);
  EXPECT_GT(path->length_m, 0);
}

TEST_F(LiveSessionFiles, FollowsNothingWithoutCalibration) {
  LiveOptions options;
  options.processing.trajectory = true;
  LiveSession session(options, [] { return source_of({2, 0.01, false, "", -1}); });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  EXPECT_THROW(session.end(), Error);
  EXPECT_EQ(session.board().status().message, "--trajectory needs --calibration");
}

TEST(LiveSession, ThrowsIfFirstOpeningFails) {
  EXPECT_THROW(LiveSession({}, []() -> std::unique_ptr<io::FrameSource> { throw Error("no such camera"); }), Error);
}

TEST(LiveSession, EndThrowsFailureOfSource) {
  LiveSession session({}, [] { return source_of({1, 0.001, false, "the disk is gone", -1}); });
  session.start();
  while (!session.finished()) std::this_thread::sleep_for(1ms);
  EXPECT_THROW(session.end(), Error);
  EXPECT_EQ(session.board().status().message, "the disk is gone");
}

/// `live` in this process.
nlohmann::json live_json(const std::string& arguments, const MemoryPlan& plan) {
  CLI::App app;
  add_live_command(app, [&plan](const std::vector<std::string>&, const io::SourceOptions&) { return source_of(plan); });
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  app.parse("live memory --json " + arguments);
  testing::internal::GetCapturedStderr();
  return nlohmann::json::parse(testing::internal::GetCapturedStdout());
}

TEST_F(LiveSessionFiles, JsonSummaryMatchesRecording) {
  const nlohmann::json summary =
      live_json("--max-age 60000 --record " + (folder_ / "rec").string(), {6, 0.02, false, "", -1});
  EXPECT_EQ(summary["taken"], 6);
  EXPECT_EQ(summary["processed"].get<int>() + summary["dropped"].get<int>(), 6);
  EXPECT_GT(summary["latency_ms"]["median"], 0);
  EXPECT_GT(summary["peak_memory_mib"], 1);
  const int recorded = summary["recorded"].get<int>();
  ASSERT_GE(recorded, 1);
  EXPECT_EQ(files_in(folder_ / "rec").size(), 1U + 2 * static_cast<std::size_t>(recorded));
  const std::string times = read_text(folder_ / "rec/times.txt");
  EXPECT_EQ(std::count(times.begin(), times.end(), '\n'), recorded);
  EXPECT_EQ(times.substr(0, 12), "1000.000000\n");
}

TEST_F(LiveSessionFiles, StopsAfterFramesOrSeconds) {
  EXPECT_GE(live_json("--frames 1 --max-age 60000", {100000, 0.02, false, "", -1})["processed"], 1);
  EXPECT_GE(live_json("--seconds 0.1 --loop", {2, 0.02, false, "", -1})["taken"], 3);
}

}  // namespace
}  // namespace roadstereo::cli
