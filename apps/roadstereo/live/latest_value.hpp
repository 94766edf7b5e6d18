#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace roadstereo::cli {

/// Mailbox for one value between two threads. A new value replaces one that was not taken yet, so that `put` never
/// waits.
template <class T>
class LatestValue {
 public:
  /// Stores a value. Returns whether one was dropped: the previous value, or this one because the mailbox is closed.
  [[nodiscard]] bool put(T thing) {
    bool lost = false;
    {
      const std::lock_guard lock(mutex_);
      lost = closed_ || thing_.has_value();
      if (!closed_) thing_.emplace(std::move(thing));
    }
    filled_.notify_one();
    return lost;
  }

  /// Waits for a value. Returns nullopt if the mailbox is closed and empty.
  std::optional<T> take() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [this] { return closed_ || thing_.has_value(); });
    return std::exchange(thing_, std::nullopt);
  }

  /// Closes the mailbox; a stored value can still be taken.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    filled_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::optional<T> thing_;
  bool closed_ = false;
};

}  // namespace roadstereo::cli
