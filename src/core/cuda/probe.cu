#include <cuda_runtime.h>

#include "core/cuda/probe.hpp"

namespace roadstereo::cuda {
namespace {

__global__ void empty_kernel() {}

}  // namespace

cudaError_t probe_code(int& compute_capability) {
  cudaFuncAttributes attributes{};
  const cudaError_t status = cudaFuncGetAttributes(&attributes, empty_kernel);
  compute_capability = attributes.ptxVersion;
  return status;
}

}  // namespace roadstereo::cuda
