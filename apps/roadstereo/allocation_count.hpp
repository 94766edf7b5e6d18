#pragma once

#include <cstddef>
#include <optional>

namespace roadstereo {

/// What the process has asked the heap for, counted in malloc itself so that nothing escapes: the C++ library, TBB and
/// OpenCV all end there.
struct Allocations {
  std::size_t count = 0;       ///< calls so far
  std::size_t live_bytes = 0;  ///< in use now
  std::size_t peak_bytes = 0;  ///< most in use since reset_peak
};

/// Nothing where malloc cannot be counted: other C libraries than glibc, and sanitizers, which replace it themselves.
std::optional<Allocations> allocations();

/// Makes what is in use now the peak.
void reset_peak();

}  // namespace roadstereo
