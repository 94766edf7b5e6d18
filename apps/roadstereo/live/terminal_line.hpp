#pragma once

#include <string>

#include "live/clock.hpp"
#include "live/live_board.hpp"

namespace roadstereo::cli {

/// Formats the status line: latency as median/95th percentile, height above the road, damages as current/total.
std::string status_line(const LiveStatus& status);

/// Status line on stderr: rewritten on a terminal, else printed every few seconds. The destructor ends the line.
class TerminalLine {
 public:
  TerminalLine();
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  /// Prints the line if it is due; call it often.
  void show(const LiveStatus& status);

 private:
  bool terminal_;
  bool written_ = false;  ///< the current line has no end yet
  Clock::time_point due_{};
  std::string message_;  ///< last printed message
};

}  // namespace roadstereo::cli
