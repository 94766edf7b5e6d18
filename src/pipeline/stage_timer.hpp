#pragma once

#include <chrono>

namespace roadstereo {

using Clock = std::chrono::steady_clock;

inline double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Adds the milliseconds of its lifetime to the time of a stage.
class StageTimer {
 public:
  explicit StageTimer(double& ms) : ms_(ms) {}
  ~StageTimer() { ms_ += ms_since(begin_); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& ms_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace roadstereo
