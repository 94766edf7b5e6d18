#pragma once

#include <exception>
#include <mutex>
#include <utility>

namespace roadstereo::cli {

/// Keeps the first exception of several threads.
class FirstException {
 public:
  /// Runs `work`. If it throws, keeps the exception if it is the first one, and calls `on_failure`.
  template <class Work, class OnFailure>
  void run(const Work& work, const OnFailure& on_failure) {
    try {
      work();
    } catch (...) {
      keep(std::current_exception());
      on_failure();
    }
  }

  /// Rethrows the first exception, if any.
  void rethrow() {
    const std::lock_guard lock(mutex_);
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  void keep(std::exception_ptr exception) {
    const std::lock_guard lock(mutex_);
    if (!exception_) exception_ = std::move(exception);
  }

  std::mutex mutex_;
  std::exception_ptr exception_;
};

}  // namespace roadstereo::cli
