#pragma once

#include <algorithm>

namespace roadstereo::cli {

/// The pauses between attempts to get a lost camera back, seconds: each twice as long as the one before, up to a limit.
class RetryPause {
 public:
  RetryPause() = default;
  RetryPause(double first_s, double max_s) : first_s_(first_s), max_s_(max_s) {}

  double next() {
    next_s_ = next_s_ == 0 ? first_s_ : std::min(2 * next_s_, max_s_);
    return next_s_;
  }

  /// The camera is back.
  void reset() { next_s_ = 0; }

 private:
  double first_s_ = 0.5;
  double max_s_ = 5;
  double next_s_ = 0;
};

}  // namespace roadstereo::cli
