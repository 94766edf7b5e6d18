#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace roadstereo::cli {

/// Lets threads do something one after the other in a given order, whichever is ready first.
class Sequencer {
 public:
  explicit Sequencer(std::int64_t first) : next_(first) {}

  /// Calls `action` when it is the turn of `place`; never when the order was broken off.
  template <class Action>
  void run_in_order(std::int64_t place, const Action& action) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return broken_ || next_ == place; });
    if (broken_) return;
    action();
    ++next_;
    changed_.notify_all();
  }

  /// No turn comes any more.
  void break_off() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t next_;
  bool broken_ = false;
};

}  // namespace roadstereo::cli
