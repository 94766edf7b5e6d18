#pragma once

#include <cuda_runtime.h>

namespace roadstereo::cuda {

/// Last-block-done pattern (CUDA sample threadFenceReduction): returns true in every thread of the last of `blocks`
/// blocks to call it, which sees what the others wrote before. `arrived` begins and ends as 0. `shared` is one number
/// of the block's shared memory.
__device__ inline bool comes_last(unsigned* arrived, unsigned blocks, unsigned* shared) {
  __threadfence();
  __syncthreads();
  if (threadIdx.x == 0) *shared = atomicAdd(arrived, 1U);
  __syncthreads();
  const bool last = *shared == blocks - 1;
  __syncthreads();  // before `shared` serves again
  if (!last) return false;
  __threadfence();
  if (threadIdx.x == 0) *arrived = 0;
  return true;
}

}  // namespace roadstereo::cuda
