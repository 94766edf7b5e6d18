#pragma once

#include <cstdint>

#include "core/cuda/block_select.hpp"
#include "core/cuda/unroll.hpp"
#include "core/cuda/warp.hpp"

// Radix select of keys that the threads of a block hold in registers. Every thread of the block calls these; blocks
// have whole warps in one dimension.
namespace roadstereo::cuda {

/// Shared memory of a RegisterSelect. Digits take the counts in turn: one is counted while the next is cleared, and the
/// one before may still be read.
struct RegisterSelectScratch {
  static constexpr int bits = 8, bins = 1 << bits, turns = 3;
  struct alignas(16) Counts {
    int of_bin[bins];
    int of_none[warp_lanes];  ///< a lane without a key counts here, so that nothing branches; nobody reads it
  };
  Counts counts[turns];
};

/// Keys have at most 32 bits, and are below `no_key`.
class RegisterSelect {
  using Scratch = RegisterSelectScratch;

 public:
  static constexpr int float_digits = 4;  ///< of the key of a float
  static constexpr std::uint32_t no_key = 0xFFFFFFFFU;

  /// Every thread has one of its own on the same scratch, as long as the block runs.
  __device__ explicit RegisterSelect(Scratch& scratch) : scratch_(scratch) {
    for (int turn = 0; turn < Scratch::turns; ++turn) clear(turn);
    __syncthreads();
  }

  /// Returns the key of the rank `rank_of(number of keys)`: digit by digit from the highest, with one barrier each.
  template <int digits, int count, class RankOf>
  __device__ SelectedKey select(const std::uint32_t (&keys)[count], RankOf rank_of) {
    static_assert(digits * Scratch::bits <= 32);
    SelectedKey selected{0, 0};
    int rank = 0;
    // A fit's code is run through once: fetching it takes long.
    ROADSTEREO_DO_NOT_UNROLL
    for (int digit = 0; digit < digits; ++digit) {
      const int shift = Scratch::bits * (digits - 1 - digit);
      Scratch::Counts& counts = scratch_.counts[turn_];
      turn_ = turn_ + 1 < Scratch::turns ? turn_ + 1 : 0;
      clear(turn_);
      // Keys with the digits that are known differ from them in the others only.
      const std::uint32_t known = digit == 0 ? 0 : selected.key << (shift + Scratch::bits);
      const std::uint32_t others = 0xFFFFFFFFU >> (32 - Scratch::bits - shift);
      int* of_none = counts.of_none + threadIdx.x % warp_lanes;
      ROADSTEREO_UNROLL
      for (int k = 0; k < count; ++k) {
        const bool counted = keys[k] != no_key && (keys[k] ^ known) <= others;
        atomicAdd(counted ? counts.of_bin + (keys[k] >> shift) % Scratch::bins : of_none, 1);
      }
      __syncthreads();
      if (!choose(digit == 0, counts.of_bin, rank_of, selected, rank)) return {0, 0};
    }
    return selected;
  }

  /// A whole warp finds the value of a digit that the key of the rank has, and its rank among the keys with that value.
  template <class RankOf>
  __device__ static bool choose(bool first, const int* counts, RankOf rank_of, SelectedKey& selected, int& rank) {
    const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
    int until[of_lane];  // keys of this lane's values up to each of them
    const auto* fours = reinterpret_cast<const int4*>(counts) + lane * of_lane / 4;
    ROADSTEREO_UNROLL
    for (int i = 0; i < of_lane; i += 4) {
      const int4 four = fours[i / 4];
      until[i] = four.x;
      until[i + 1] = four.y;
      until[i + 2] = four.z;
      until[i + 3] = four.w;
    }
    ROADSTEREO_UNROLL
    for (int i = 1; i < of_lane; ++i) until[i] += until[i - 1];
    const int end = sum_until(until[of_lane - 1]), begin = end - until[of_lane - 1];
    if (first) {
      selected.of = __shfl_sync(whole_warp, end, warp_lanes - 1);
      if (selected.of == 0) return false;
      rank = rank_of(selected.of);
    }
    int value = 0, below = 0;
    ROADSTEREO_UNROLL
    for (int i = 0; i + 1 < of_lane; ++i) {
      const bool beyond = rank - begin >= until[i];
      value += beyond ? 1 : 0;
      below = beyond ? until[i] : below;
    }
    const int holder = __ffs(static_cast<int>(__ballot_sync(whole_warp, rank < end))) - 1;
    const int digit = holder * of_lane + __shfl_sync(whole_warp, value, holder);
    rank -= __shfl_sync(whole_warp, begin + below, holder);
    selected.key = selected.key << Scratch::bits | static_cast<std::uint32_t>(digit);
    return true;
  }

 private:
  static constexpr int of_lane = Scratch::bins / warp_lanes;  ///< neighbouring values of a digit

  __device__ void clear(int turn) {
    for (int i = static_cast<int>(threadIdx.x); i < Scratch::bins; i += static_cast<int>(blockDim.x)) {
      scratch_.counts[turn].of_bin[i] = 0;
    }
  }

  Scratch& scratch_;
  int turn_ = 0;
};

/// Shared memory of select_ranks().
template <int ranks>
struct RanksScratch {
  RegisterSelectScratch::Counts counts[ranks];
  SelectedKey selected[ranks];
  int rank[ranks];
};

/// The keys of several ranks at a time, for which all barriers serve: number r is that of `rank_of[r]` among the keys
/// of set `set_of_rank`. Every thread may read them until the next call.
template <int digits, int... set_of_rank, int sets, int count, class RankOf>
__device__ const SelectedKey* select_ranks(const std::uint32_t (&keys)[sets][count],
                                           const RankOf (&rank_of)[sizeof...(set_of_rank)],
                                           RanksScratch<sizeof...(set_of_rank)>& scratch) {
  using Scratch = RegisterSelectScratch;
  constexpr int ranks = sizeof...(set_of_rank);
  constexpr int set_of[ranks] = {set_of_rank...};
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  if (thread < ranks) scratch.selected[thread] = {0, 0};
  ROADSTEREO_DO_NOT_UNROLL
  for (int digit = 0; digit < digits; ++digit) {
    for (int i = thread; i < ranks * Scratch::bins; i += threads) {
      scratch.counts[i / Scratch::bins].of_bin[i % Scratch::bins] = 0;
    }
    __syncthreads();
    const int shift = Scratch::bits * (digits - 1 - digit);
    const std::uint32_t others = 0xFFFFFFFFU >> (32 - Scratch::bits - shift);
    ROADSTEREO_UNROLL
    for (int r = 0; r < ranks; ++r) {
      Scratch::Counts& counts = scratch.counts[r];
      const std::uint32_t known = digit == 0 ? 0 : scratch.selected[r].key << (shift + Scratch::bits);
      int* of_none = counts.of_none + thread % warp_lanes;
      ROADSTEREO_UNROLL
      for (int k = 0; k < count; ++k) {
        const std::uint32_t key = keys[set_of[r]][k];
        const bool counted = key != RegisterSelect::no_key && (key ^ known) <= others;
        atomicAdd(counted ? counts.of_bin + (key >> shift) % Scratch::bins : of_none, 1);
      }
    }
    __syncthreads();
    for (int r = thread / warp_lanes; r < ranks; r += threads / warp_lanes) {
      SelectedKey selected = scratch.selected[r];
      int rank = digit > 0 ? scratch.rank[r] : 0;
      if (digit > 0 && selected.of == 0) continue;
      RegisterSelect::choose(digit == 0, scratch.counts[r].of_bin, rank_of[r], selected, rank);
      __syncwarp();  // all lanes have read
      if (thread % warp_lanes != 0) continue;
      scratch.selected[r] = selected;
      scratch.rank[r] = rank;
    }
    __syncthreads();
  }
  return scratch.selected;
}

}  // namespace roadstereo::cuda
