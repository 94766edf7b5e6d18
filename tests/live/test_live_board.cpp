// What the viewers of a live run see.

#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "live/live_board.hpp"

namespace roadstereo::cli {
namespace {

LiveView view_of(double age_s) {
  LiveView view;
  view.arrival = Clock::now() - clock_span(age_s);
  return view;
}

TEST(LiveBoard, StateFollowsAgeOfView) {
  LiveBoard board(1000);
  EXPECT_EQ(board.status().state, LiveState::starting);
  board.publish(view_of(2000));
  EXPECT_EQ(board.status().state, LiveState::stale);
  EXPECT_GE(board.status().age_s, 2000);
  board.publish(view_of(1));
  EXPECT_EQ(board.status().state, LiveState::live);
  board.lose_camera("gone");
  EXPECT_EQ(board.status().state, LiveState::reconnecting);
  EXPECT_EQ(board.status().message, "gone");
  board.camera_is_back();
  EXPECT_EQ(board.status().state, LiveState::live);
  EXPECT_EQ(board.status().message, "");
  EXPECT_EQ(board.status().counts.reconnects, 1);
  board.end();
  EXPECT_EQ(board.status().state, LiveState::ended);
}

TEST(LiveBoard, LatencyIsFromArrivalToPublication) {
  LiveBoard board(1000);
  for (const double age : {0.3, 0.2, 0.1}) board.publish(view_of(age));
  const LiveStatus status = board.status();
  EXPECT_GE(status.view->latency_ms, 100);
  EXPECT_GE(status.latency.median_ms, 200);
  EXPECT_GE(status.latency.p95_ms, 300);
  EXPECT_EQ(status.latency.max_ms, board.latency_of_all().max_ms);
  EXPECT_GE(1000 * status.age_s, status.view->latency_ms) << "what is shown is never younger than it was at first";
}

TEST(LiveBoard, PublishWakesWaiter) {
  LiveBoard board(1000);
  auto waiting = std::async(std::launch::async, [&board] { return board.wait_for_news(0, 60); });
  board.publish(view_of(0));
  EXPECT_EQ(waiting.get().view->number, 1);
  EXPECT_EQ(board.wait_for_news(0, 60).view->number, 1) << "what is there already is not waited for";
  EXPECT_EQ(board.wait_for_news(1, 0.01).view->number, 1) << "time is up";
  waiting = std::async(std::launch::async, [&board] { return board.wait_for_news(1, 60); });
  board.end();
  EXPECT_EQ(waiting.get().state, LiveState::ended);
}

TEST(LiveBoard, KeepsLatestViews) {
  LiveBoard board(1000);
  EXPECT_EQ(board.view(0), nullptr);
  for (int i = 0; i < 9; ++i) board.publish(view_of(0));
  EXPECT_EQ(board.view(8)->number, 8);
  EXPECT_EQ(board.view(2)->number, 9) << "gone: the newest";
}

PairHealth with_row_offset(double px) {
  PairHealth health;
  health.row_offset_px = px;
  return health;
}

TEST(RecentHealth, TellsVibrationOfLastPairs) {
  RecentHealth recent;
  for (int i = 0; i <= 200; ++i) recent.add(with_row_offset(i % 2 == 0 ? 0.1 : 0.7));
  ASSERT_EQ(recent.findings().size(), 1U);
  EXPECT_EQ(recent.findings()[0].id, "vibration");
  EXPECT_NEAR(recent.vibration_px(), 1.4826 * 0.6 / std::sqrt(2.0), 1e-9);
  for (int i = 0; i < 200; ++i) recent.add(with_row_offset(0.1));
  EXPECT_EQ(recent.vibration_px(), 0);
  EXPECT_TRUE(recent.findings().empty());
}

TEST(RecentHealth, TellsLostPairsOnceThereAreHundred) {
  RecentHealth recent;
  for (int i = 0; i < 2; ++i) recent.add_without_result();
  for (int i = 0; i < 97; ++i) recent.add(PairHealth{});
  EXPECT_TRUE(std::isnan(recent.lost_share()));
  EXPECT_TRUE(recent.findings().empty());
  recent.add(PairHealth{});
  EXPECT_DOUBLE_EQ(recent.lost_share(), 0.02);
  ASSERT_EQ(recent.findings().size(), 1U);
  EXPECT_EQ(recent.findings()[0].id, "lost-pairs");
  for (int i = 0; i < 100; ++i) recent.add(PairHealth{});
  EXPECT_DOUBLE_EQ(recent.lost_share(), 0.01);
  EXPECT_TRUE(recent.findings().empty()) << "the limit is 1 %";
}

}  // namespace
}  // namespace roadstereo::cli
