#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace roadstereo::synth {

// Random numbers as functions of a key: no state, so that neither the number of threads nor the order of the
// pixels matters, and no standard distribution, so that every standard library draws the same.

/// A 32-bit mix in which every input bit reaches every output bit.
inline std::uint32_t mix32(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

/// The same for 64 bits (the finaliser of SplitMix64).
inline std::uint64_t mix64(std::uint64_t h) {
  h += 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

/// Uniform in [0, 1) from the upper bits of a hash.
inline double unit_interval(std::uint64_t hash) {
  return static_cast<double>(hash >> 11) * 0x1p-53;
}

/// Standard normal value of a key (Box and Muller).
inline double normal_value(std::uint64_t key) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - unit_interval(mix64(key))));
  return radius * std::cos(2.0 * std::numbers::pi * unit_interval(mix64(key ^ 0xd1b54a32d192ed03u)));
}

/// A sequence of draws for the construction of scenes.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(mix64(seed)) {}

  double uniform(double low, double high) { return low + (high - low) * unit_interval(mix64(state_++)); }
  int integer(int low, int high) { return low + static_cast<int>(uniform(0, high - low + 1)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  std::uint32_t seed() { return static_cast<std::uint32_t>(mix64(state_++) >> 32); }

 private:
  std::uint64_t state_;
};

}  // namespace roadstereo::synth
