#pragma once

namespace roadstereo::cuda {

/// How many keys of a radix select have each value of a digit of 11 bits, and each group of values.
struct DigitCounts {
  static constexpr int bits = 11, bins = 1 << bits;
  static constexpr int group = 32, groups = bins / group;
  int of_bin[bins];
  int of_group[groups];
};

}  // namespace roadstereo::cuda
