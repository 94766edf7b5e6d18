// Recording beside the view: it neither waits nor hides a full disk.

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "live/recorder.hpp"
#include "tests/live/live_test.hpp"

namespace roadstereo::cli {
namespace {

TEST(Recorder, BlockedDiskDoesNotBlockOffer) {
  LiveBoard board(1000);
  std::promise<void> begun, freed;
  std::atomic<int> written = 0;
  {
    Recorder recorder(
        [&](const RecordedPair& pair) {
          if (written++ == 0) begun.set_value();
          if (pair.time_s == 0) freed.get_future().wait();
        },
        board);
    recorder.offer(frames_pair(), 0);
    begun.get_future().wait();
    const int most = static_cast<int>(Recorder::max_waiting);
    for (int i = 1; i <= most + 5; ++i) recorder.offer(frames_pair(), i);  // would hang if it waited
    EXPECT_EQ(board.status().recording.skipped, 5);
    EXPECT_EQ(board.status().recording.recorded, 0);
    freed.set_value();
  }
  EXPECT_EQ(board.status().recording.recorded, 1 + static_cast<int>(Recorder::max_waiting)) << "the rest is written";
  EXPECT_EQ(board.status().recording.message, "");
}

TEST(Recorder, FullDiskStopsWithMessage) {
  LiveBoard board(1000);
  std::atomic<int> tried = 0;
  {
    Recorder recorder(
        [&](const RecordedPair& pair) {
          ++tried;
          if (pair.time_s > 0) throw SystemError("no space left");
        },
        board);
    recorder.offer(frames_pair(), 0);
    recorder.offer(frames_pair(), 1);
    while (board.status().recording.message.empty()) std::this_thread::yield();
    recorder.offer(frames_pair(), 2);
  }
  const RecordingState state = board.status().recording;
  EXPECT_EQ(tried, 2);
  EXPECT_EQ(state.recorded, 1);
  EXPECT_EQ(state.skipped, 2);
  EXPECT_EQ(state.message, "recording stopped: no space left");
}

}  // namespace
}  // namespace roadstereo::cli
