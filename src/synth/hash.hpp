#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace roadstereo::synth {

// Counter-based random numbers: stateless functions of a key, so that results do not depend on the number of threads or
// the order of the pixels. Standard distributions are avoided, because they differ between standard libraries.

/// 32-bit integer hash (lowbias32 of C. Wellons): every input bit affects every output bit.
inline std::uint32_t mix32(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

/// 64-bit integer hash (finaliser of SplitMix64).
inline std::uint64_t mix64(std::uint64_t h) {
  h += 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

/// Uniform value in [0, 1) from the upper 53 bits of a hash.
inline double unit_interval(std::uint64_t hash) {
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

/// Standard normal value of a key (Box–Muller transform).
inline double normal_value(std::uint64_t key) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - unit_interval(mix64(key))));
  return radius * std::cos(2.0 * std::numbers::pi * unit_interval(mix64(key ^ 0xd1b54a32d192ed03u)));
}

/// Sequence of random values for the construction of scenes.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : state_(mix64(seed)) {}

  double uniform(double lower, double upper) { return lower + (upper - lower) * unit_interval(mix64(state_++)); }
  /// Uniform integer in [first, last].
  int integer(int first, int last) { return first + static_cast<int>(uniform(0, last - first + 1)); }
  bool bernoulli(double probability) { return uniform(0, 1) < probability; }
  std::uint32_t seed() { return static_cast<std::uint32_t>(mix64(state_++) >> 32); }

 private:
  std::uint64_t state_;
};

}  // namespace roadstereo::synth
