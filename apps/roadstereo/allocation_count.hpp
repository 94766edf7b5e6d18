#pragma once

#include <cstddef>
#include <optional>

namespace roadstereo {

/// Heap allocations of the process, counted in malloc itself, which the C++ library, TBB and OpenCV all call.
struct Allocations {
  std::size_t count = 0;       ///< calls so far
  std::size_t live_bytes = 0;  ///< in use now
  std::size_t peak_bytes = 0;  ///< maximum in use since reset_peak
};

/// Returns nullopt if malloc cannot be counted: not glibc, or with sanitizers, which replace it themselves.
std::optional<Allocations> allocations();

/// Sets the peak to the current use.
void reset_peak();

}  // namespace roadstereo
