#include "core/cuda/check.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo::cuda {

void check(cudaError_t status, const char* call) {
  if (status == cudaSuccess) return;
  static_cast<void>(cudaGetLastError());  // so that the next call is not blamed for it
  fail<SystemError>("CUDA: ", call, " failed: ", cudaGetErrorString(status), " (", cudaGetErrorName(status), ")");
}

}  // namespace roadstereo::cuda
