// When the pairs of a recording are due.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>

#include "live/playback.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {
namespace {

using namespace std::chrono_literals;

io::SourcePair pair_at(std::int64_t index, double time_s = std::nan("")) {
  io::SourcePair pair;
  pair.index = index;
  pair.time_s = time_s;
  return pair;
}

TEST(Playback, PairsAreDueAtTheirTimes) {
  Playback playback(0);
  const Clock::time_point start{};
  EXPECT_EQ(playback.due(pair_at(0, 500), start), start);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(1, 500.5), start)), 0.5, 1e-6);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(2, 502), start + 9s)), 2, 1e-6) << "due, however late it is";
}

TEST(Playback, RateReplacesTimes) {
  Playback playback(10);
  const Clock::time_point start{};
  EXPECT_EQ(playback.due(pair_at(5, 500), start), start);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(8, 777), start)), 0.3, 1e-6);
}

TEST(Playback, CountsOverduePairs) {
  Playback playback(10);
  const Clock::time_point start{};
  playback.due(pair_at(0), start);
  EXPECT_EQ(playback.overdue(start + 500ms), 4);
  playback.due(pair_at(1), start);  // at 0.1 s; the next ones at 0.2, 0.3, ...
  EXPECT_EQ(playback.overdue(start + 150ms), 0);
  EXPECT_EQ(playback.overdue(start + 250ms), 0) << "the one of 0.2 s is the newest";
  EXPECT_EQ(playback.overdue(start + 350ms), 1);
  EXPECT_EQ(playback.overdue(start + 1050ms), 8);
}

TEST(Playback, OnePairWithoutRateTellsNoInterval) {
  Playback playback(0);
  const Clock::time_point start{};
  playback.due(pair_at(0, 100), start);
  EXPECT_EQ(playback.overdue(start + 500ms), 0);
}

/// One pair, again and again.
TEST(Playback, RateHoldsForLoopOfOnePair) {
  Playback playback(2);
  const Clock::time_point start{};
  playback.due(pair_at(0), start);
  playback.begin_again();
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(0), start)), 0.5, 1e-6);
}

TEST(Playback, NextRoundFollowsLastPair) {
  Playback playback(0);
  const Clock::time_point start{};
  playback.due(pair_at(0, 100), start);
  playback.due(pair_at(1, 100.25), start);
  playback.begin_again();
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(0, 100), start)), 0.5, 1e-6);
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(1, 100.25), start)), 0.75, 1e-6);
}

/// A damaged message of a bag has no time. The pairs around it keep theirs.
TEST(Playback, RejectedPairsWithoutTimeAreDueAtOnce) {
  Playback playback(0);
  const Clock::time_point start{};
  const auto rejected = [](std::int64_t index) {
    io::SourcePair pair = pair_at(index);
    pair.error = "damaged";
    return pair;
  };
  EXPECT_EQ(playback.due(rejected(0), start), start);
  EXPECT_EQ(playback.due(pair_at(1, 500), start + 1s), start + 1s);
  EXPECT_EQ(playback.due(rejected(2), start + 1s), start + 1s) << "nothing tells the interval yet";
  EXPECT_NEAR(seconds_between(start, playback.due(pair_at(3, 500.5), start + 1s)), 1.5, 1e-6);
  EXPECT_NEAR(seconds_between(start, playback.due(rejected(4), start + 1s)), 1.75, 1e-6);
}

TEST(Playback, NeedsTimesOrRate) {
  Playback playback(0);
  EXPECT_THROW(playback.due(pair_at(0), Clock::now()), Error);
}

}  // namespace
}  // namespace roadstereo::cli
