// The line that a terminal shows during a live run.

#include <gtest/gtest.h>

#include <memory>

#include "live/terminal_line.hpp"

namespace roadstereo::cli {
namespace {

TEST(TerminalLine, ShowsStateAndFigures) {
  LiveStatus status;
  EXPECT_EQ(status_line(status), "starting for 0.0 s");
  auto view = std::make_shared<LiveView>();
  view->geometry.emplace();
  view->geometry->roll_rad = 0.1;
  view->geometry->roll_observable = true;
  view->damages.resize(2);
  status.view = view;
  status.state = LiveState::stale;
  status.age_s = 1.5;
  status.fps = 29.96;
  status.latency = {40.4, 61.2, 99};
  status.damages_found = 7;
  status.counts.dropped = 3;
  status.recording = {true, 5, 1, ""};
  EXPECT_EQ(
      status_line(status),
      "stale 30.0 fps, latency 40/61 ms, age 1500 ms, roll 5.73°, damages 2/7, dropped 3, recorded 5 (1 skipped)");
}

}  // namespace
}  // namespace roadstereo::cli
