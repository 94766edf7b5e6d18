#pragma once

#include <cuda_runtime.h>

namespace roadstereo::cuda {

constexpr int warp_lanes = 32;
constexpr unsigned whole_warp = 0xFFFFFFFFU;

// From compute capability 8 on the hardware finds the smallest whole number of a warp in one step.
#if defined(ROADSTEREO_CUDA_EMULATED) || (defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800)
#define ROADSTEREO_WARP_REDUCES 1
#else
#define ROADSTEREO_WARP_REDUCES 0
#endif

/// The smallest of the numbers of a warp's lanes, none of which is NaN.
__device__ inline float warp_min(float value) {
#if ROADSTEREO_WARP_REDUCES
  // As whole numbers in the order of the floats.
  const int bits = __float_as_int(value);
  const int least = __reduce_min_sync(whole_warp, bits ^ ((bits >> 31) & 0x7FFFFFFF));
  return __int_as_float(least ^ ((least >> 31) & 0x7FFFFFFF));
#else
  for (int distance = warp_lanes / 2; distance > 0; distance /= 2) {
    value = fminf(value, __shfl_xor_sync(whole_warp, value, distance));
  }
  return value;
#endif
}

/// The same of numbers that are not negative but for rounding, in fewer steps: as whole numbers, floats above zero are
/// in order; of several below it the
/// one nearest to zero may be returned.
__device__ inline float warp_min_of_costs(float value) {
#if ROADSTEREO_WARP_REDUCES
  return __int_as_float(__reduce_min_sync(whole_warp, __float_as_int(value)));
#else
  return warp_min(value);
#endif
}

/// The largest of the numbers of a warp's lanes.
__device__ inline int warp_max(int value) {
#if ROADSTEREO_WARP_REDUCES
  return __reduce_max_sync(whole_warp, value);
#else
  for (int distance = warp_lanes / 2; distance > 0; distance /= 2) {
    const int other = __shfl_xor_sync(whole_warp, value, distance);
    value = other > value ? other : value;
  }
  return value;
#endif
}

}  // namespace roadstereo::cuda
