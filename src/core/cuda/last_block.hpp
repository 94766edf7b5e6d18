#pragma once

#include <cuda_runtime.h>

namespace roadstereo::cuda {

/// True in all threads of the one block of `blocks` that comes here last: it sees what the others wrote before, and
/// leaves `arrived`, which begins as 0, as it was. `shared` is one number of the block's shared memory.
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
