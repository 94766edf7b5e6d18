// A slot of one pair, whose newest item wins.

#include <gtest/gtest.h>

#include <optional>
#include <thread>

#include "live/latest_value.hpp"

namespace roadstereo::cli {
namespace {

TEST(LatestValue, NewestReplacesWaiting) {
  LatestValue<int> slot;
  EXPECT_FALSE(slot.put(1));
  EXPECT_TRUE(slot.put(2));
  EXPECT_TRUE(slot.put(3));
  EXPECT_EQ(slot.take(), 3);
  EXPECT_FALSE(slot.put(4));
  slot.close();
  EXPECT_TRUE(slot.put(5));
  EXPECT_EQ(slot.take(), 4);
  EXPECT_EQ(slot.take(), std::nullopt);
}

TEST(LatestValue, EveryItemIsTakenOrLost) {
  constexpr int things = 20000;
  LatestValue<int> slot;
  int lost = 0, fetched = 0, last = -1;
  std::thread fetching([&] {
    while (const auto thing = slot.take()) {
      EXPECT_GT(*thing, last);
      last = *thing;
      ++fetched;
    }
  });
  for (int i = 0; i < things; ++i) lost += slot.put(i) ? 1 : 0;
  slot.close();
  fetching.join();
  EXPECT_EQ(last, things - 1);
  EXPECT_EQ(fetched + lost, things);
}

}  // namespace
}  // namespace roadstereo::cli
