#pragma once

#include <cstdint>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Disparities first ≤ d < end. C++17, for kernels.
struct SearchRange {
  std::int16_t first = 0;
  std::int16_t end = 0;

  friend bool operator==(const SearchRange& a, const SearchRange& b) { return a.first == b.first && a.end == b.end; }
};

}  // namespace roadstereo
#pragma GCC visibility pop
