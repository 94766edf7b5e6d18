#pragma once

#include <string>

#include "live/clock.hpp"
#include "live/live_board.hpp"

namespace roadstereo::cli {

/// How things stand in one line: latency as median/95th percentile, height over the road, damages as seen now/in all.
std::string status_line(const LiveStatus& status);

/// The line on stderr: rewritten on a terminal, a plain one every few seconds elsewhere. Its end is a new line.
class TerminalLine {
 public:
  TerminalLine();
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  /// Called often; prints what has become due.
  void show(const LiveStatus& status);

 private:
  bool terminal_;
  bool written_ = false;  ///< a line that has no end yet
  Clock::time_point due_{};
  std::string message_;  ///< the last one that was printed
};

}  // namespace roadstereo::cli
