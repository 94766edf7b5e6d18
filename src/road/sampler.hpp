#pragma once

#include <cstddef>
#include <cstdint>

namespace roadstereo {

/// Random numbers for drawing samples: the same sequence on every machine and in every run (splitmix64).
class Sampler {
 public:
  explicit Sampler(std::uint64_t seed = 1) : state_(seed) {}

  /// A number in [0, count).
  std::size_t below(std::size_t count) {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<std::size_t>((z ^ (z >> 31)) % count);
  }

 private:
  std::uint64_t state_;
};

}  // namespace roadstereo
