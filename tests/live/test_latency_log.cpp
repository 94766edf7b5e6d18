// Latencies and rates over a run.

#include <gtest/gtest.h>

#include <chrono>

#include "live/latency_log.hpp"
#include "live/rate_meter.hpp"

namespace roadstereo::cli {
namespace {

using namespace std::chrono_literals;

TEST(LatencyLog, QuantilesAreRanks) {
  LatencyLog log;
  for (int i = 100; i >= 1; --i) log.add(i);
  for (const LatencyStatistics& figures : {log.recent(), log.all()}) {
    EXPECT_EQ(figures.median_ms, 50);
    EXPECT_EQ(figures.p95_ms, 95);
    EXPECT_EQ(figures.max_ms, 100);
  }
}

TEST(LatencyLog, RecentForgetsOldValues) {
  LatencyLog log;
  for (int i = 0; i < 1000; ++i) log.add(9000);
  for (int i = 0; i < 150; ++i) log.add(20.1);
  EXPECT_EQ(log.recent().max_ms, 20.1);
  EXPECT_EQ(log.all().max_ms, 9000);
  EXPECT_EQ(log.all().median_ms, 9000) << "beyond the bins";
  for (int i = 0; i < 2000; ++i) log.add(20.1);
  EXPECT_EQ(log.all().median_ms, 20.25) << "to a quarter of a millisecond, from above";
}

TEST(RateMeter, CountsOpenGap) {
  RateMeter meter;
  const Clock::time_point start{};
  for (int i = 0; i <= 100; ++i) meter.add(start + i * 40ms);
  EXPECT_NEAR(meter.per_second(start + 4s), 25, 1e-6);
  EXPECT_NEAR(meter.per_second(start + 5s), 25.0 / (1 + 0.96), 0.6);
  EXPECT_EQ(meter.per_second(start + 7s), 0);
}

}  // namespace
}  // namespace roadstereo::cli
