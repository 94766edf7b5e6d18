#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

namespace roadstereo::cuda {

/// Throws SystemError with the text of CUDA unless `status` is success.
void check(cudaError_t status, const char* call);

/// Shared memory that every device has for a block.
inline constexpr std::size_t max_shared_bytes = std::size_t{48} << 10;

/// Throws Error when a block needs more than that.
void require_shared_memory(std::size_t bytes);

}  // namespace roadstereo::cuda

/// Calls the CUDA runtime; throws SystemError naming the call when it fails.
#define ROADSTEREO_CUDA(call) ::roadstereo::cuda::check((call), #call)
