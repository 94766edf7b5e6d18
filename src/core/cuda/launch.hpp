#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <tuple>
#include <utility>

#include "core/cuda/check.hpp"
#if defined(ROADSTEREO_CUDA_EMULATED)
#include <run_kernel.hpp>  // of tests/cuda/emulated
#endif

namespace roadstereo::cuda {

/// How many threads run a kernel, and the shared memory of each block.
struct LaunchShape {
  dim3 grid;
  dim3 block;
  std::size_t shared_bytes = 0;
};

/// Blocks of `size` that cover `count`.
inline unsigned blocks_for(int count, int size) {
  return static_cast<unsigned>((count + size - 1) / size);
}

#if !defined(ROADSTEREO_CUDA_EMULATED)
/// Allows the kernel more than 48 KB of shared memory per block. The setting belongs to the kernel, which pipelines
/// share: it is the device's maximum, not the need of this launch.
inline void ask_for_shared_memory(const void* kernel, std::size_t bytes) {
  constexpr std::size_t without_asking = 48U << 10;
  if (bytes <= without_asking) return;
  int device = 0, most = 0;
  ROADSTEREO_CUDA(cudaGetDevice(&device));
  ROADSTEREO_CUDA(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
  require_shared_memory(bytes, most);
  ROADSTEREO_CUDA(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, most));
}
#endif

/// Launches `kernel` in the stream; throws SystemError when that fails.
template <class... Parameters, class... Arguments>
void launch(void (*kernel)(Parameters...), const LaunchShape& shape, cudaStream_t stream, Arguments&&... arguments) {
  static_assert((sizeof(Parameters) + ... + 0) <= 3500, "a kernel takes at most 4 KB of parameters");
  std::tuple<Parameters...> values(std::forward<Arguments>(arguments)...);
#if defined(ROADSTEREO_CUDA_EMULATED)
  static_cast<void>(stream);
  emulated::run_kernel(shape.grid, shape.block, shape.shared_bytes, [&] { std::apply(kernel, values); });
#else
  const void* function = reinterpret_cast<const void*>(kernel);
  ask_for_shared_memory(function, shape.shared_bytes);
  std::apply(
      [&](auto&... value) {
        void* pointers[] = {static_cast<void*>(&value)...};
        ROADSTEREO_CUDA(cudaLaunchKernel(function, shape.grid, shape.block, pointers, shape.shared_bytes, stream));
      },
      values);
#endif
}

/// The shared memory of the block; aligned for vectors of four floats. For kernels.
template <class T>
__device__ T* shared_memory() {
#if defined(ROADSTEREO_CUDA_EMULATED)
  return reinterpret_cast<T*>(emulated::shared_memory());
#else
  extern __shared__ __align__(16) unsigned char roadstereo_shared_bytes[];
  return reinterpret_cast<T*>(roadstereo_shared_bytes);
#endif
}

}  // namespace roadstereo::cuda
