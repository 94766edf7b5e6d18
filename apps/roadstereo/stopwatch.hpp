#pragma once

#include <chrono>

namespace roadstereo::cli {

/// Returns the duration of a call, milliseconds.
template <class Call>
double time_ms(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace roadstereo::cli
