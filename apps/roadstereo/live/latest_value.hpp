#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace roadstereo::cli {

/// Room for one thing between two threads: what is put in takes the place of what was not fetched yet, so that the
/// newest wins and nobody waits for the one who fetches.
template <class T>
class LatestValue {
 public:
  /// Whether something was lost: what waited here, or the thing itself because the slot is closed.
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

  /// Waits for the next thing; nothing when the slot is closed and empty.
  std::optional<T> take() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [this] { return closed_ || thing_.has_value(); });
    return std::exchange(thing_, std::nullopt);
  }

  /// Nothing more is put in; what waits can still be fetched.
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
