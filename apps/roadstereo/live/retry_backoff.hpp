#pragma once

#include <algorithm>

namespace roadstereo::cli {

/// Exponential backoff between attempts to reconnect a camera, seconds.
class RetryBackoff {
 public:
  RetryBackoff() = default;
  RetryBackoff(double first_s, double max_s) : first_s_(first_s), max_s_(max_s) {}

  double next() {
    next_s_ = next_s_ == 0 ? first_s_ : std::min(2 * next_s_, max_s_);
    return next_s_;
  }

  /// Restarts with the first pause.
  void reset() { next_s_ = 0; }

 private:
  double first_s_ = 0.5;
  double max_s_ = 5;
  double next_s_ = 0;
};

}  // namespace roadstereo::cli
