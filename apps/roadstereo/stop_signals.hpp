#pragma once

#include <array>
#include <csignal>

namespace roadstereo::cli {

/// Catches the first Ctrl-C or similar signal so that a program can finish its work; the second ends it. Signals that
/// the caller of the program ignores (nohup) stay ignored. One at a time.
class StopSignals {
 public:
  StopSignals();

  /// Restores the default: the next Ctrl-C ends the program.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Waits up to that time. Returns whether a signal has arrived since the construction.
  bool wait(double seconds) const;

 private:
  static constexpr std::array signals_ = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals_.size()> before_{};
};

}  // namespace roadstereo::cli
