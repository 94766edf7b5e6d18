// The files of a recording.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "live/recording_folder.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/image_file.hpp"
#include "tests/live/live_test.hpp"

namespace roadstereo::cli {
namespace {

using RecordingFolderFiles = LiveFiles;

/// Samples of every value that a camera of 16 bits may give.
Frame deep_frame() {
  Frame frame{std::vector<std::uint8_t>(2 * 64 * 48), 64, 48, SampleType::u16, ChannelOrder::grey};
  std::iota(frame.bytes.begin(), frame.bytes.end(), static_cast<std::uint8_t>(0));
  return frame;
}

TEST_F(RecordingFolderFiles, KeepEverySample) {
  const io::SourcePair pair = frames_pair();
  {
    RecordingFolder folder(folder_ / "rec", "focal_px: 1\n");
    folder.write({pair.left, pair.right, 1700000000.25});
    folder.write({deep_frame(), deep_frame(), 1700000000.5});
  }
  EXPECT_EQ(files_in(folder_ / "rec"),
            (std::set<std::string>{"calibration.yaml", "times.txt", "left/000000.png", "left/000001.png",
                                   "right/000000.png", "right/000001.png"}));
  EXPECT_EQ(read_text(folder_ / "rec/times.txt"), "1700000000.250000\n1700000000.500000\n");
  EXPECT_EQ(read_text(folder_ / "rec/calibration.yaml"), "focal_px: 1\n");
  EXPECT_EQ(io::read_frame((folder_ / "rec/left/000000.png").string()).bytes, pair.left.bytes);
  EXPECT_EQ(io::read_frame((folder_ / "rec/right/000000.png").string()).bytes, pair.right.bytes);
  EXPECT_EQ(io::read_frame((folder_ / "rec/left/000001.png").string()).bytes, deep_frame().bytes);
}

TEST_F(RecordingFolderFiles, FailedPairLeavesNoFile) {
  RecordingFolder folder(folder_ / "rec", {});
  folder.write({deep_frame(), deep_frame(), 1});
  std::filesystem::remove_all(folder_ / "rec/right");
  write("rec/right", "in the way");
  EXPECT_THROW(folder.write({deep_frame(), deep_frame(), 2}), SystemError);
  EXPECT_EQ(files_in(folder_ / "rec"), (std::set<std::string>{"left/000000.png", "right", "times.txt"}));
  EXPECT_EQ(read_text(folder_ / "rec/times.txt"), "1.000000\n");
}

/// Counts the pairs of a recording. Fails if one that is not the last cannot be read.
int readable_pairs(const std::filesystem::path& folder) {
  const auto source = io::open_source({folder.string()});
  int pairs = 0;
  for (std::int64_t i = 0; i < source->size(); ++i) {
    const auto pair = source->next();
    EXPECT_TRUE(pair->error.empty() || i + 1 == *source->size()) << pair->error;
    if (pair->error.empty()) ++pairs;
  }
  return pairs;
}

TEST_F(RecordingFolderFiles, KillLosesLastPairOnly) {
  constexpr int kills = 200;
  int unfinished = 0;
  for (int i = 0; i < kills; ++i) {
    const std::filesystem::path recording = folder_ / std::to_string(i);
    const pid_t child = ::fork();
    if (child == 0) {
      RecordingFolder folder(recording, {});
      for (int pair = 0;; ++pair) folder.write({deep_frame(), deep_frame(), 0.1 * pair});
    }
    while (!std::filesystem::exists(recording / "times.txt") || read_text(recording / "times.txt").size() < 27) {
    }
    std::this_thread::sleep_for(std::chrono::microseconds(37 * i));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::string times = read_text(recording / "times.txt");
    const auto pairs = std::count(times.begin(), times.end(), '\n');
    EXPECT_EQ(readable_pairs(recording), pairs);
    unfinished += files_in(recording).size() > static_cast<std::size_t>(2 * pairs + 1) ? 1 : 0;
    std::filesystem::remove_all(recording);
  }
  RecordProperty("killed_within_a_pair", unfinished);
  EXPECT_GE(unfinished, 1);
}

TEST_F(RecordingFolderFiles, AreNotOverwritten) {
  RecordingFolder(folder_ / "rec", "focal_px: 1\n");
  EXPECT_TRUE(files_in(folder_ / "rec").empty()) << "without a pair nothing stays";
  {
    RecordingFolder folder(folder_ / "rec", {});
    folder.write({deep_frame(), deep_frame(), 1});
  }
  EXPECT_THROW(RecordingFolder(folder_ / "rec", {}), Error);
  std::filesystem::create_directories(folder_ / "gone");
  std::filesystem::create_symlink("nowhere/right", folder_ / "gone/right");
  EXPECT_THROW(RecordingFolder(folder_ / "gone", "focal_px: 1\n"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "gone/left")) << "what fails can be tried again";
  std::filesystem::create_directories(folder_ / "mine");
  write("mine/calibration.yaml", "focal_px: 2\n");
  EXPECT_THROW(RecordingFolder(folder_ / "mine", "focal_px: 1\n"), Error);
  RecordingFolder(folder_ / "mine", "focal_px: 2\n");
  RecordingFolder(folder_ / "mine", {});
  EXPECT_EQ(read_text(folder_ / "mine/calibration.yaml"), "focal_px: 2\n") << "it was there before";
}

}  // namespace
}  // namespace roadstereo::cli
