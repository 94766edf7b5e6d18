// What the threads of a flight hand to each other with: nothing is lost, nothing overtakes, and an end frees who waits.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "flight/bounded_queue.hpp"
#include "flight/sequencer.hpp"

namespace roadstereo::cli {
namespace {

TEST(BoundedQueue, KeepsOrderAndBound) {
  constexpr int items = 2000;
  BoundedQueue<std::unique_ptr<int>> queue(3);
  std::atomic<int> inside{0};
  int most = 0;
  std::thread producer([&] {
    for (int i = 0; i < items; ++i) {
      ASSERT_TRUE(queue.put(std::make_unique<int>(i)));
      ++inside;
    }
    queue.close();
  });
  int expected = 0;
  while (std::optional<std::unique_ptr<int>> item = queue.take()) {
    most = std::max(most, inside--);
    EXPECT_EQ(**item, expected++);
  }
  producer.join();
  EXPECT_EQ(expected, items);
  EXPECT_LE(most, 3 + 1) << "one may have been counted in before it was counted out";
}

TEST(BoundedQueue, CloseKeepsItemsAndAbandonDropsThem) {
  BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.put(1));
  EXPECT_TRUE(queue.put(2));
  queue.close();
  EXPECT_FALSE(queue.put(3));
  EXPECT_EQ(queue.take(), 1);
  queue.abandon();
  EXPECT_EQ(queue.take(), std::nullopt);
}

TEST(BoundedQueue, CloseAndAbandonWakeWaiters) {
  BoundedQueue<int> full(1);
  BoundedQueue<int> empty(1);
  EXPECT_TRUE(full.put(1));
  std::thread putting([&] { EXPECT_FALSE(full.put(2)); });
  std::thread taking([&] { EXPECT_EQ(empty.take(), std::nullopt); });
  full.abandon();
  empty.close();
  putting.join();
  taking.join();
}

TEST(Sequencer, RunsInOrder) {
  constexpr int first = 5;
  constexpr int places = 400;
  constexpr int workers = 4;
  Sequencer sequencer(first);
  std::vector<int> order;  // guarded by the sequencer
  std::atomic<int> next{first};
  std::vector<std::thread> threads;
  for (int i = 0; i < workers; ++i) {
    threads.emplace_back([&] {
      for (int place = next++; place < first + places; place = next++) {
        sequencer.run_in_order(place, [&] { order.push_back(place); });
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_EQ(order.size(), static_cast<std::size_t>(places));
  for (int i = 0; i < places; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], first + i);
}

TEST(Sequencer, CancelWakesWaiters) {
  Sequencer sequencer(0);
  bool called = false;
  std::thread waiting([&] { sequencer.run_in_order(7, [&] { called = true; }); });
  sequencer.cancel();
  waiting.join();
  sequencer.run_in_order(0, [&] { called = true; });
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace roadstereo::cli
