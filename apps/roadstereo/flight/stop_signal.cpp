#include "flight/stop_signal.hpp"

#include <array>
#include <atomic>
#include <csignal>

namespace roadstereo::cli {

namespace {

constexpr std::array signals = {SIGINT, SIGTERM};

// A signal comes to the process, not to an object.
std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void ask_to_stop(int signal) {
  asked = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

StopSignal::StopSignal() {
  asked = false;
  for (const int signal : signals) std::signal(signal, ask_to_stop);
}

StopSignal::~StopSignal() {
  for (const int signal : signals) std::signal(signal, SIG_DFL);
}

bool StopSignal::requested() const {
  return asked;
}

}  // namespace roadstereo::cli
