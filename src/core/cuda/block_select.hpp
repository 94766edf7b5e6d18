#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/digit_counts.hpp"
#include "core/cuda/unroll.hpp"

// Radix select: order statistics of keys of two digits, of which all blocks have counted the first and one block counts
// the second. Every thread of the block calls these; blocks have whole warps in one dimension.
namespace roadstereo::cuda {

/// Shared memory of block_select(): a count for each digit.
struct SelectScratch {
  DigitCounts counts[2];
  std::uint32_t prefix;
  int rank;
  int of;
};

/// The selected key, and the number of keys; none when 0.
struct SelectedKey {
  std::uint32_t key;
  int of;
};

/// A float as a key of 32 bits of the same order; and back. NaN has no place.
__device__ inline std::uint32_t key_of(float value) {
  const auto bits = static_cast<std::uint32_t>(__float_as_int(value));
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}
__device__ inline float value_of(std::uint32_t key) {
  return __int_as_float(static_cast<int>((key & 0x80000000U) != 0 ? key & 0x7FFFFFFFU : ~key));
}

/// Ranks counted from the smallest, of `count` values in order: the upper median, and the value that `share` of the
/// others lie below.
struct MiddleRank {
  __device__ int operator()(int count) const { return count / 2; }
};
struct ShareRank {
  double share;
  __device__ int operator()(int count) const { return static_cast<int>(share * (count - 1)); }
};

/// The sum of the values of a warp's lanes up to this one.
__device__ inline int sum_until(int value) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  for (int by = 1; by < warp_lanes; by *= 2) {
    const int before = __shfl_up_sync(whole_warp, value, static_cast<unsigned>(by));
    if (lane >= by) value += before;
  }
  return value;
}

/// The first warp finds the value of a digit that the key of the rank has, and how many keys have smaller ones.
template <class RankOf>
__device__ void choose_digit(bool first, const DigitCounts& counts, RankOf rank_of, SelectScratch& scratch) {
  static_assert(DigitCounts::group == warp_lanes && DigitCounts::groups == 2 * warp_lanes);
  const int lane = static_cast<int>(threadIdx.x);
  const int low = counts.of_group[2 * lane], high = counts.of_group[2 * lane + 1];
  const int until = sum_until(low + high), below = until - low - high;
  const int all = __shfl_sync(whole_warp, until, warp_lanes - 1);
  const int rank = first ? rank_of(all) : scratch.rank;
  const std::uint32_t known = first ? 0 : scratch.prefix;
  if (first && lane == 0) scratch.of = all;
  const unsigned holders = __ballot_sync(whole_warp, rank >= below && rank < until);
  if (holders == 0) return;
  const int holder = __ffs(static_cast<int>(holders)) - 1;
  const bool in_high = rank >= below + low;
  const int group = __shfl_sync(whole_warp, 2 * lane + (in_high ? 1 : 0), holder);
  const int below_group = __shfl_sync(whole_warp, in_high ? below + low : below, holder);
  const int own = counts.of_bin[group * warp_lanes + lane];
  const int end = below_group + sum_until(own);
  __syncwarp();  // all lanes have read the rank
  if (rank < end - own || rank >= end) return;
  scratch.prefix = known << DigitCounts::bits | static_cast<std::uint32_t>(group * warp_lanes + lane);
  scratch.rank = rank - (end - own);
}

__device__ inline void count_digit(std::uint32_t digit, DigitCounts& counts) {
  atomicAdd(&counts.of_bin[digit], 1);
  atomicAdd(&counts.of_group[digit / warp_lanes], 1);
}

__device__ inline void clear_counts(DigitCounts& counts) {
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  for (int i = thread; i < DigitCounts::bins; i += threads) counts.of_bin[i] = 0;
  for (int i = thread; i < DigitCounts::groups; i += threads) counts.of_group[i] = 0;
}

/// Takes the counts of all values of a digit from global memory.
__device__ inline void load_counts(const int* of_bin, DigitCounts& counts) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  for (int i = static_cast<int>(threadIdx.x); i < DigitCounts::bins; i += static_cast<int>(blockDim.x)) {
    const int own = of_bin[i];
    counts.of_bin[i] = own;
    const int until = sum_until(own);
    if (lane == warp_lanes - 1) counts.of_group[i / warp_lanes] = until;
  }
}

/// Returns the key of the rank `rank_of(number of keys)`. `first_digits`, in global memory, has how many keys have each
/// value of the first digit. `key_of_item(i, key)` returns whether item i of `count` has a key, and writes it; a thread
/// asks for `at_once` before it counts one, since memory takes long.
template <int at_once, class KeyOfItem, class RankOf>
__device__ SelectedKey block_select(int count, KeyOfItem key_of_item, RankOf rank_of, const int* first_digits,
                                    SelectScratch& scratch) {
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  load_counts(first_digits, scratch.counts[0]);
  clear_counts(scratch.counts[1]);
  __syncthreads();
  if (thread < warp_lanes) choose_digit(true, scratch.counts[0], rank_of, scratch);
  __syncthreads();
  if (scratch.of == 0) return {0, 0};
  const std::uint32_t first_digit = scratch.prefix;
  for (int first = thread; first < count; first += at_once * threads) {
    std::uint32_t keys[at_once] = {};
    bool has[at_once];
    ROADSTEREO_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const int i = first + k * threads;
      has[k] = key_of_item(i < count ? i : first, keys[k]);  // no branch keeps the reads from each other
    }
    ROADSTEREO_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const bool counted = has[k] && first + k * threads < count;
      if (counted && keys[k] >> DigitCounts::bits == first_digit) {
        count_digit(keys[k] % DigitCounts::bins, scratch.counts[1]);
      }
    }
  }
  __syncthreads();
  if (thread < warp_lanes) choose_digit(false, scratch.counts[1], rank_of, scratch);
  __syncthreads();
  return {scratch.prefix, scratch.of};
}

}  // namespace roadstereo::cuda
