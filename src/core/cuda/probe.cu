#include <cuda_runtime.h>

#include "core/cuda/probe.hpp"

namespace roadstereo::cuda {
namespace {

__global__ void nothing() {}

}  // namespace

cudaError_t probe_code() {
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, nothing);
}

}  // namespace roadstereo::cuda
