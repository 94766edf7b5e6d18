#include "core/cuda/check.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cuda {

void check(cudaError_t status, const char* call) {
  if (status == cudaSuccess) return;
  static_cast<void>(cudaGetLastError());  // so that the next call is not blamed for it
  fail<SystemError>("CUDA: ", call, " failed: ", cudaGetErrorString(status), " (", cudaGetErrorName(status), ")");
}

void require_shared_memory(std::size_t bytes) {
  if (bytes <= max_shared_bytes) return;
  fail("the engine cuda needs ", bytes, " bytes of shared memory for these options; a block has at most ",
       max_shared_bytes, ": take a smaller window or fewer disparities");
}

}  // namespace roadstereo::cuda
