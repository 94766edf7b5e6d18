#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "core/cuda/block_reduce.hpp"

// For kernels whose blocks have whole warps in one dimension: every thread of the block calls these.
namespace roadstereo::cuda {

/// Shared memory of block_select().
struct SelectScratch {
  static constexpr int bins = 256;
  int counts[bins];
  std::uint32_t prefix;
  int rank;
  int of;
};

/// The key asked for, and how many keys there were: none when 0.
struct SelectedKey {
  std::uint32_t key;
  int of;
};

/// A float as a key of the same order; and back. NaN has no place.
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

/// The first warp finds the bin that holds the key of the rank, and how many keys lie in the bins before it.
template <class RankOf>
__device__ void choose_bin(int shift, RankOf rank_of, SelectScratch& scratch) {
  constexpr int of_lane = SelectScratch::bins / warp_size;
  const int lane = static_cast<int>(threadIdx.x), first = lane * of_lane;
  int own = 0;
  for (int bin = first; bin < first + of_lane; ++bin) own += scratch.counts[bin];
  int until = own;
  for (int by = 1; by < warp_size; by *= 2) {
    const int before = __shfl_up_sync(every_lane, until, static_cast<unsigned>(by));
    if (lane >= by) until += before;
  }
  const int all = __shfl_sync(every_lane, until, warp_size - 1);
  const bool first_digit = shift == 24;
  const int rank = first_digit ? rank_of(all) : scratch.rank;
  __syncwarp();
  if (first_digit && lane == 0) scratch.of = all;
  int below = until - own;
  if (rank < below || rank >= until) return;
  int bin = first;
  while (rank >= below + scratch.counts[bin]) below += scratch.counts[bin++];
  scratch.prefix |= static_cast<std::uint32_t>(bin) << shift;
  scratch.rank = rank - below;
}

/// The key of the rank `rank_of(number of keys)`, by radix: digit by digit from the highest. `key_of_item(i, key)` says
/// whether item i of `count` has a key, and which; an item is always asked for by the same thread.
template <class KeyOfItem, class RankOf>
__device__ SelectedKey block_select(int count, KeyOfItem key_of_item, RankOf rank_of, SelectScratch& scratch) {
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  std::uint32_t prefix = 0;
  for (int shift = 24; shift >= 0; shift -= 8) {
    for (int bin = thread; bin < SelectScratch::bins; bin += threads) scratch.counts[bin] = 0;
    if (thread == 0) scratch.prefix = prefix;
    __syncthreads();
    const std::uint32_t known = shift == 24 ? 0 : 0xFFFFFFFFU << (shift + 8);
    for (int i = thread; i < count; i += threads) {
      std::uint32_t key = 0;
      if (key_of_item(i, key) && (key & known) == prefix) atomicAdd(&scratch.counts[(key >> shift) & 255U], 1);
    }
    __syncthreads();
    if (thread < warp_size) choose_bin(shift, rank_of, scratch);
    __syncthreads();
    prefix = scratch.prefix;
    const int of = scratch.of;
    __syncthreads();  // before the next digit's counts
    if (of == 0) return {0, 0};
  }
  return {prefix, scratch.of};
}

}  // namespace roadstereo::cuda
