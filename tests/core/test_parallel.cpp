#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "core/parallel.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

TEST(ParallelThreads, VisitEveryIndexOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    std::vector<std::atomic<int>> visits(1000);
    std::atomic<bool> in_range{true};
    parallel_for(1000, threads, [&](int i, int worker) {
      ++visits[static_cast<std::size_t>(i)];
      if (worker < 0 || worker >= threads) in_range = false;
    });
    for (const auto& count : visits) ASSERT_EQ(count, 1);
    EXPECT_TRUE(in_range);
  }
}

TEST(ParallelThreads, FewerIndicesThanThreads) {
  for (const int count : {1, 2, 3}) {
    std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
    std::atomic<bool> in_range{true};
    parallel_for(count, 7, [&](int i, int worker) {
      ++visits[static_cast<std::size_t>(i)];
      if (worker < 0 || worker >= 7) in_range = false;
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    EXPECT_TRUE(in_range);
  }
}

TEST(ParallelThreads, NeverShareWorkerNumber) {
  std::vector<std::atomic<int>> busy(4);
  std::atomic<bool> shared{false};
  parallel_for(200, 4, [&](int, int worker) {
    if (busy[static_cast<std::size_t>(worker)].fetch_add(1) != 0) shared = true;
    std::this_thread::yield();
    busy[static_cast<std::size_t>(worker)].fetch_sub(1);
  });
  EXPECT_FALSE(shared);
}

TEST(ParallelThreads, BandsCoverRowsWithoutOverlap) {
  std::vector<std::atomic<int>> visits(101);
  parallel_rows(101, 8, 2, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) ++visits[static_cast<std::size_t>(v)];
  });
  for (const auto& count : visits) ASSERT_EQ(count, 1);
}

TEST(ParallelThreads, ExceptionReachesCaller) {
  EXPECT_THROW(parallel_for(50, 2,
                            [](int i, int) {
                              if (i == 33) fail("row ", i);
                            }),
               Error);
  EXPECT_THROW(resolve_threads(-1), Error);
  EXPECT_THROW(resolve_threads(1025), Error);
  EXPECT_GE(resolve_threads(5), 1);
  EXPECT_LE(resolve_threads(5), 5);
  EXPECT_GE(resolve_threads(0), 1);
}

}  // namespace
}  // namespace roadstereo
