#pragma once

#include <csignal>

namespace roadstereo::cli {

/// Ctrl-C and the like, waited for instead of handled: made before any thread, so that all of them leave the signals
/// alone.
class StopSignals {
 public:
  StopSignals();

  /// The usual meaning comes back: another Ctrl-C ends the program.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one came within so many seconds, less than one.
  bool wait(double seconds) const;

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace roadstereo::cli
