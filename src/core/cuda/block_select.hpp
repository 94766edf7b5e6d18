#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/unroll.hpp"

// Radix select: order statistics of the keys of a block of threads. Every thread of the block calls these; blocks have
// whole warps in one dimension.
namespace roadstereo::cuda {

/// Shared memory of block_select().
struct SelectScratch {
  static constexpr int bins = 256;
  static constexpr int digits = 4;
  __align__(16) int counts[digits][bins];
  std::uint32_t prefix;
  int rank;
  int of;
};

/// The selected key, and the number of keys; none when 0.
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

/// The first warp finds the bin of a digit that holds the key of the rank, and how many keys lie in the bins before it.
template <class RankOf>
__device__ void choose_bin(int digit, RankOf rank_of, SelectScratch& scratch) {
  constexpr int of_lane = SelectScratch::bins / warp_lanes;
  static_assert(of_lane == 8, "two vectors of four");
  const int lane = static_cast<int>(threadIdx.x);
  const auto* counts = reinterpret_cast<const int4*>(scratch.counts[digit]) + 2 * lane;
  const int4 a = counts[0], b = counts[1];
  const int own[of_lane] = {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w};
  int until = 0;
  for (int i = 0; i < of_lane; ++i) until += own[i];
  int below = -until;
  for (int by = 1; by < warp_lanes; by *= 2) {
    const int before = __shfl_up_sync(whole_warp, until, static_cast<unsigned>(by));
    if (lane >= by) until += before;
  }
  below += until;
  const int all = __shfl_sync(whole_warp, until, warp_lanes - 1);
  const int rank = digit == 0 ? rank_of(all) : scratch.rank;
  __syncwarp();
  if (digit == 0 && lane == 0) scratch.of = all;
  if (rank < below || rank >= until) return;
  int bin = of_lane * lane;
  bool before = true;
  for (int i = 0; i < of_lane; ++i) {
    before = before && rank >= below + own[i];
    if (before) below += own[i];
    if (before) ++bin;
  }
  const std::uint32_t known = digit == 0 ? 0 : scratch.prefix;
  scratch.prefix = known << 8 | static_cast<std::uint32_t>(bin);
  scratch.rank = rank - below;
}

/// Returns the key of the rank `rank_of(number of keys)`: digit by digit from the highest, with two barriers each.
/// `key_of_item(i, key)` returns whether item i of `count` has a key, and writes it; an item is always asked for by the
/// same thread, which asks for `at_once` before it counts one, since memory takes long.
template <int at_once = 4, class KeyOfItem, class RankOf>
__device__ SelectedKey block_select(int count, KeyOfItem key_of_item, RankOf rank_of, SelectScratch& scratch) {
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  for (int i = thread; i < SelectScratch::digits * SelectScratch::bins; i += threads) {
    scratch.counts[i / SelectScratch::bins][i % SelectScratch::bins] = 0;
  }
  __syncthreads();
  std::uint32_t prefix = 0;
  for (int digit = 0; digit < SelectScratch::digits; ++digit) {
    const int shift = 24 - 8 * digit;
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
        const bool counts = has[k] && first + k * threads < count;
        if (counts && (digit == 0 || keys[k] >> (shift + 8) == prefix)) {
          atomicAdd(&scratch.counts[digit][(keys[k] >> shift) & 255U], 1);
        }
      }
    }
    __syncthreads();
    if (thread < warp_lanes) choose_bin(digit, rank_of, scratch);
    __syncthreads();
    if (scratch.of == 0) return {0, 0};
    prefix = scratch.prefix;
  }
  return {prefix, scratch.of};
}

}  // namespace roadstereo::cuda
