#pragma once

#include <csignal>

namespace roadstereo::cli {

/// Blocks Ctrl-C and similar signals and waits for them. Create it before any thread, so that all threads inherit the
/// mask.
class StopSignals {
 public:
  StopSignals();

  /// Restores the default: the next Ctrl-C ends the program.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Waits up to that time, less than 1 s. Returns whether a signal has arrived.
  bool wait(double seconds) const;

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace roadstereo::cli
