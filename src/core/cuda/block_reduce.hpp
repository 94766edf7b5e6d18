#pragma once

#include "core/cuda/warp.hpp"

// Block reductions in a fixed tree. Every thread of the block calls these; blocks have whole warps in one dimension.
namespace roadstereo::cuda {

/// Values of shared memory that block_sums() of `count` values works in.
constexpr int sums_scratch(int count) {
  return (warp_lanes + 1) * count;
}

/// Adds up `count` values over the lanes of a warp, in a fixed tree. At each step a lane hands half of what it carries
/// to its partner, so that ten values take 12 exchanges instead of 50. `first` and `end` are narrowed to the value that
/// the lane ends with; it has none when they meet.
template <int mask, class T, int count>
__device__ T fold_lanes(const T (&values)[count], int& first, int& end) {
  if constexpr (mask == 0) {
    static_assert(count == 1, "a warp folds at most 32 values");
    return values[0];
  } else {
    constexpr int kept = (count + 1) / 2;
    const bool upper = (static_cast<int>(threadIdx.x) & mask) != 0;
    T rest[kept];
    for (int i = 0; i < kept; ++i) {
      const T low = values[i], high = i + kept < count ? values[i + kept < count ? i + kept : i] : T{};
      rest[i] = (upper ? high : low) + __shfl_xor_sync(whole_warp, upper ? low : high, mask);
    }
    if (upper) {
      first = first + kept < end ? first + kept : end;
    } else {
      end = first + kept < end ? first + kept : end;
    }
    return fold_lanes<mask / 2>(rest, first, end);
  }
}

/// Sums `count` values over the threads of the block, in a fixed tree; every thread may read the sums in `scratch`,
/// shared memory, until the next call.
template <class T, int count>
__device__ const T* block_sums(const T (&values)[count], T* scratch) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes, own = static_cast<int>(threadIdx.x) / warp_lanes;
  const int warps = static_cast<int>(blockDim.x) / warp_lanes;
  int first = 0, end = count;
  const T sum = fold_lanes<warp_lanes / 2>(values, first, end);
  __syncthreads();  // the last call's sums have been read
  if (first < end) scratch[own * count + first] = sum;
  __syncthreads();
  T* totals = scratch + warp_lanes * count;
  for (int i = own; i < count; i += warps) {
    T total = lane < warps ? scratch[lane * count + i] : T{};
    for (int mask = warp_lanes / 2; mask > 0; mask /= 2) total += __shfl_xor_sync(whole_warp, total, mask);
    if (lane == 0) totals[i] = total;
  }
  __syncthreads();
  return totals;
}

/// Returns the value of all threads that `better(a, b)` prefers; `scratch` has room for warp_lanes + 1.
template <class T, class Better>
__device__ T block_best(T value, Better better, T* scratch) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes, own = static_cast<int>(threadIdx.x) / warp_lanes;
  const int warps = static_cast<int>(blockDim.x) / warp_lanes;
  const auto best_of_warp = [&](T best) {
    for (int mask = warp_lanes / 2; mask > 0; mask /= 2) {
      const T other = __shfl_xor_sync(whole_warp, best, mask);
      if (better(other, best)) best = other;
    }
    return best;
  };
  value = best_of_warp(value);
  __syncthreads();
  if (lane == 0) scratch[own] = value;
  __syncthreads();
  if (own == 0) {
    const T best = best_of_warp(scratch[lane < warps ? lane : 0]);
    if (lane == 0) scratch[warp_lanes] = best;
  }
  __syncthreads();
  return scratch[warp_lanes];
}

/// Orders for block_best().
struct Least {
  template <class T>
  __device__ bool operator()(T a, T b) const {
    return a < b;
  }
};
struct Greatest {
  template <class T>
  __device__ bool operator()(T a, T b) const {
    return b < a;
  }
};

}  // namespace roadstereo::cuda
