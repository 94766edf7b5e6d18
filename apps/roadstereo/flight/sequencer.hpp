#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace roadstereo::cli {

/// Serialises actions of several threads in the order of their numbers.
class Sequencer {
 public:
  explicit Sequencer(std::int64_t first) : next_(first) {}

  /// Waits until all actions before `sequence` are done and calls `action`. Returns without calling it after `cancel`.
  template <class Action>
  void run_in_order(std::int64_t sequence, const Action& action) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return cancelled_ || next_ == sequence; });
    if (cancelled_) return;
    action();
    ++next_;
    changed_.notify_all();
  }

  /// Releases all waiting threads.
  void cancel() {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t next_;
  bool cancelled_ = false;
};

}  // namespace roadstereo::cli
