#pragma once

#include <cstddef>
#include <cstdint>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Random number in [0, count): the k-th of a sequence that is the same on every machine and in every run (splitmix64).
ROADSTEREO_HD inline std::uint64_t random_number(std::uint64_t k, std::uint64_t count) {
  std::uint64_t z = 1 + (k + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return (z ^ (z >> 31)) % count;
}

/// Draws samples: these numbers, one after another.
class Sampler {
 public:
  /// A number in [0, count).
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_number(drawn_++, count)); }

 private:
  std::uint64_t drawn_ = 0;
};

}  // namespace roadstereo
