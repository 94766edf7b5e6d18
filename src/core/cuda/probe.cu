#include "core/cuda/launch.hpp"
#include "core/cuda/probe.hpp"

namespace roadstereo::cuda {
namespace {

__global__ void empty_kernel() {}

}  // namespace

cudaError_t probe_code() {
#if defined(ROADSTEREO_CUDA_EMULATED)
  launch(empty_kernel, {1, 1}, nullptr);
  return cudaSuccess;
#else
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, empty_kernel);
#endif
}

}  // namespace roadstereo::cuda
