#include "core/cuda/launch.hpp"
#include "core/cuda/probe.hpp"

namespace roadstereo::cuda {
namespace {

__global__ void nothing() {}

}  // namespace

cudaError_t probe_code() {
#if defined(ROADSTEREO_CUDA_EMULATED)
  launch(nothing, {1, 1}, nullptr);
  return cudaSuccess;
#else
  cudaFuncAttributes attributes{};
  return cudaFuncGetAttributes(&attributes, nothing);
#endif
}

}  // namespace roadstereo::cuda
