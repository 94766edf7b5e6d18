#include "stop_signals.hpp"

#include <ctime>
#include <initializer_list>

namespace roadstereo::cli {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

StopSignals::~StopSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool StopSignals::wait(double seconds) const {
  constexpr double nanoseconds = 1e9;
  const timespec span{0, static_cast<long>(seconds * nanoseconds)};
  return sigtimedwait(&signals_, nullptr, &span) > 0;
}

}  // namespace roadstereo::cli
