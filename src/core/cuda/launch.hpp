#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <tuple>
#include <utility>

#include "core/cuda/check.hpp"
#include "core/cuda/stream.hpp"
#if defined(ROADSTEREO_CUDA_EMULATED)
#include <run_kernel.hpp>  // of tests/cuda/emulated
#endif

namespace roadstereo::cuda {

/// Blocks of `size` that cover `count`.
inline unsigned blocks_for(int count, int size) {
  return static_cast<unsigned>((count + size - 1) / size);
}

/// The first line of every kernel of the library (scripts/check_layers.py): it may begin before the last one of its
/// stream has ended (programmatic dependent launch), so that the time of a launch is hidden, and waits here until that
/// has ended and its memory is seen.
__device__ inline void begin_kernel() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.launch_dependents;");
  asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

#if !defined(ROADSTEREO_CUDA_EMULATED)
/// With the attribute of programmatic dependent launch where the stream and the toolkit have it.
inline void launch_function(const void* function, const LaunchShape& shape, void** arguments, StreamView stream) {
#if CUDART_VERSION >= 11080
  cudaLaunchAttribute programmatic{};
  programmatic.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  programmatic.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = shape.grid;
  config.blockDim = shape.block;
  config.dynamicSmemBytes = shape.shared_bytes;
  config.stream = stream.get();
  config.attrs = &programmatic;
  config.numAttrs = stream.programmatic() ? 1 : 0;
  ROADSTEREO_CUDA(cudaLaunchKernelExC(&config, function, arguments));
#else
  ROADSTEREO_CUDA(cudaLaunchKernel(function, shape.grid, shape.block, arguments, shape.shared_bytes, stream.get()));
#endif
}
#endif

/// Launches `kernel` in the stream; throws SystemError when that fails. `name` is that of the kernel, for records.
template <class... Parameters, class... Arguments>
void launch(const char* name, void (*kernel)(Parameters...), const LaunchShape& shape, StreamView stream,
            Arguments&&... arguments) {
  static_assert((sizeof(Parameters) + ... + 0) <= 3500, "a kernel takes at most 4 KB of parameters");
  require_shared_memory(shape.shared_bytes);
  std::tuple<Parameters...> values(std::forward<Arguments>(arguments)...);
  const void* function = reinterpret_cast<const void*>(kernel);
  Recorder* recorder = stream.recorder();
  if (recorder != nullptr) recorder->before_launch(name, function, shape, stream.get());
#if defined(ROADSTEREO_CUDA_EMULATED)
  emulated::run_kernel(shape.grid, shape.block, shape.shared_bytes, [&] { std::apply(kernel, values); });
#else
  std::apply(
      [&](auto&... value) {
        void* pointers[] = {static_cast<void*>(&value)...};
        launch_function(function, shape, pointers, stream);
      },
      values);
#endif
  if (recorder != nullptr) recorder->after_launch(stream.get());
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
