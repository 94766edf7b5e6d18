#include <cuda_runtime.h>

#include "core/cuda/probe.hpp"

namespace roadstereo::cuda {
namespace {

__global__ void empty_kernel() {}

}  // namespace

cudaError_t probe_code() {
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, empty_kernel);
}

}  // namespace roadstereo::cuda
