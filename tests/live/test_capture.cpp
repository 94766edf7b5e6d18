// From the source to the slot: dropped pairs, lost cameras, loops.

#include <gtest/gtest.h>

#include <memory>

#include "live/capture.hpp"
#include "live/retry_backoff.hpp"
#include "tests/live/live_test.hpp"

namespace roadstereo::cli {
namespace {

TEST(RetryBackoff, DoublesUpToLimitUntilReset) {
  RetryBackoff pause(0.5, 5);
  for (const double expected : {0.5, 1.0, 2.0, 4.0, 5.0, 5.0}) EXPECT_EQ(pause.next(), expected);
  pause.reset();
  EXPECT_EQ(pause.next(), 0.5);
}

/// A capture without those who fetch from its slot.
struct CaptureBench {
  LiveBoard board{1000};
  LatestValue<CapturedPair> slot;
  std::stop_source stop;

  void run(const SourceOpener& opener, CaptureOptions options = {}) {
    Capture capture(opener(), opener, options, board, slot, nullptr);
    capture.run(stop.get_token());
  }
};

TEST(Capture, DropsPairsThatAreNotTaken) {
  CaptureBench bench;
  bench.run([] { return source_of({40, 0.001, false, "", 7}); });
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(counts.taken, 40);
  EXPECT_EQ(counts.rejected, counts.taken - counts.dropped - 1) << "one waits in the slot";
  EXPECT_LE(counts.rejected, 1) << "it may have been passed over";
  bench.slot.close();
  const auto newest = bench.slot.take();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->pair.index, 39);
}

TEST(Capture, SkipsOverduePairs) {
  CaptureBench bench;
  CaptureOptions options;
  options.rate_hz = 10000;  // no memory is as fast
  bench.run([] { return source_of({3000, 0, false, "", -1}); }, options);
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(counts.taken, 3000);
  EXPECT_EQ(counts.dropped, 2999);
  bench.slot.close();
  const auto newest = bench.slot.take();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->pair.index, 2999) << "the last one is shown";
}

TEST(Capture, ReopensLostCamera) {
  CaptureBench bench;
  CaptureOptions options;
  options.pause = RetryBackoff(0.001, 0.002);
  int openings = 0;
  bench.run(
      [&]() -> std::unique_ptr<io::FrameSource> {
        ++openings;
        if (openings > 1) {
          EXPECT_EQ(bench.board.status().state, LiveState::reconnecting);
        }
        if (openings == 2) {
          EXPECT_EQ(bench.board.status().message, "unplugged");
        }
        if (openings == 3) throw Error("still unplugged");
        if (openings == 4) {
          EXPECT_EQ(bench.board.status().message, "still unplugged");
        }
        if (openings == 6) bench.stop.request_stop();
        if (openings == 2) return source_of({0, 0, true, "opened, but gives nothing", -1});
        return source_of({2, 0, true, openings == 1 ? "unplugged" : "", -1});
      },
      options);
  const LiveCounts counts = bench.board.status().counts;
  EXPECT_EQ(openings, 6);
  EXPECT_EQ(counts.reconnects, 2) << "with the openings 4 and 5: only a picture tells that it is back";
  EXPECT_EQ(counts.taken, 6);
}

TEST(Capture, FailingRecordingThrows) {
  CaptureBench bench;
  EXPECT_THROW(bench.run([] { return source_of({2, 0.001, false, "the disk is gone", -1}); }), Error);
  EXPECT_THROW(bench.run(
                   [] {
                     return source_of({0, 0.001, false, "", -1});
                   },
                   {0, true, {}}),
               Error)
      << "nothing to loop over";
}

TEST(Capture, LoopReopensSource) {
  CaptureBench bench;
  int openings = 0;
  bench.run(
      [&] {
        if (++openings == 4) bench.stop.request_stop();
        return source_of({3, 0.001, false, "", -1});
      },
      {0, true, {}});
  EXPECT_EQ(bench.board.status().counts.taken, 9);
}

}  // namespace
}  // namespace roadstereo::cli
