#include "stop_signals.hpp"

#include <semaphore.h>

#include <cerrno>
#include <cmath>
#include <ctime>

namespace roadstereo::cli {
namespace {

sem_t arrived;  // sem_post may be called by a signal handler

void handle(int /*signal*/) {
  const int error = errno;
  ::sem_post(&arrived);
  errno = error;
}

}  // namespace

StopSignals::StopSignals() {
  ::sem_init(&arrived, 0, 0);
  struct sigaction action {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    ::sigaction(signals_[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals_[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < signals_.size(); ++i) ::sigaction(signals_[i], &before_[i], nullptr);
}

bool StopSignals::wait(double seconds) const {
  constexpr double nanoseconds = 1e9;
  timespec until{};
  ::clock_gettime(CLOCK_MONOTONIC, &until);  // which nobody sets
  const double end = static_cast<double>(until.tv_nsec) + seconds * nanoseconds;
  until.tv_sec += static_cast<time_t>(end / nanoseconds);
  until.tv_nsec = static_cast<long>(std::fmod(end, nanoseconds));
  int result = 0;
  do {
    result = ::sem_clockwait(&arrived, CLOCK_MONOTONIC, &until);
  } while (result != 0 && errno == EINTR);
  if (result == 0) ::sem_post(&arrived);  // stays true
  return result == 0;
}

}  // namespace roadstereo::cli
